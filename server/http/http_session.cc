#include "server/http/http_session.h"

#include <boost/asio/post.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/file_body.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <exception>
#include <utility>

#include "server/http/ws_session.h"

namespace kinescope::http {
namespace {

namespace beast = boost::beast;
namespace bhttp = boost::beast::http;

constexpr std::uint32_t kMaxHeaderBytes = 8192;
constexpr std::uint64_t kMaxBodyBytes = 4096;  // a hand load has 100
constexpr std::chrono::seconds kReadTimeout{20};
constexpr std::chrono::seconds kWriteTimeout{60};

// The hash is that of the import map in web/index.html, the page's only inline script;
// tests/browser/unit/page_policy.test.mjs checks that they match.
constexpr const char* kContentSecurityPolicy =
    "default-src 'none'; script-src 'self' 'sha256-uknlmCvJjd+nbrhlRIsCSC5zFnRlkEkfP97X3yNRuBk='; "
    "style-src 'self'; "
    "img-src 'self' blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'";

std::string Header(const bhttp::request<bhttp::string_body>& request, bhttp::field field) {
  const auto value = request[field];
  return {value.data(), value.size()};
}

Request ToRequest(const bhttp::request<bhttp::string_body>& request) {
  return {std::string(request.method_string()),        std::string(request.target()),
          Header(request, bhttp::field::host),         Header(request, bhttp::field::origin),
          Header(request, bhttp::field::cookie),       Header(request, bhttp::field::if_none_match),
          Header(request, bhttp::field::content_type), request.body()};
}

void AddHeaders(bhttp::fields& fields, const Answer& answer) {
  fields.set(bhttp::field::server, "kinescope");
  if (answer.status != 304) fields.set(bhttp::field::content_type, answer.content_type);
  fields.set("Content-Security-Policy", kContentSecurityPolicy);
  fields.set("X-Content-Type-Options", "nosniff");
  fields.set("Referrer-Policy", "no-referrer");  // the URL may contain the token
  fields.set("Cross-Origin-Resource-Policy", "same-origin");
  for (const auto& [name, value] : answer.headers) fields.set(name, value);
}

// 0: no answer, the connection is closed.
int StatusOf(beast::error_code error) {
  if (error == bhttp::error::header_limit) return 431;
  if (error == bhttp::error::body_limit) return 413;
  if (error == bhttp::error::end_of_stream || error == bhttp::error::partial_message) return 0;
  return error.category() == make_error_code(bhttp::error::bad_value).category() ? 400 : 0;
}

}  // namespace

HttpSession::HttpSession(boost::asio::ip::tcp::socket socket, Shared& shared)
    : stream_(std::move(socket)), shared_(shared) {
  ++shared_.connections;
}

HttpSession::~HttpSession() { --shared_.connections; }

void HttpSession::Read() {
  parser_.emplace();
  parser_->header_limit(kMaxHeaderBytes);
  parser_->body_limit(kMaxBodyBytes);
  stream_.expires_after(kReadTimeout);
  bhttp::async_read(
      stream_, incoming_, *parser_,
      [self = shared_from_this()](beast::error_code error, std::size_t) { self->OnRead(error); });
}

void HttpSession::OnRead(beast::error_code error) {
  keep_alive_ = !error && parser_->keep_alive();
  is_head_ = !error && parser_->get().method() == bhttp::verb::head;
  version_ = error ? 11 : parser_->get().version();
  if (error) {
    const int status = StatusOf(error);
    if (status == 0) return;
    ++shared_.counters->rejected["bad request"];
    return Send(ErrorAnswer(status, "invalid or unsupported HTTP request"));
  }
  ++shared_.counters->requests;
  try {
    Handle();
  } catch (const std::exception& failure) {
    ++shared_.counters->failures;
    Send(ErrorAnswer(500, failure.what()));
  }
}

void HttpSession::Handle() {
  if (beast::websocket::is_upgrade(parser_->get())) return BecomeWebSocket();
  Answer answer = shared_.router->Route(ToRequest(parser_->get()));
  if (answer.snapshot) return Draw(std::move(answer));
  Send(std::move(answer));
}

void HttpSession::BecomeWebSocket() {
  if (auto refusal = shared_.router->RefuseWebSocket(ToRequest(parser_->get()))) {
    return Send(*std::move(refusal));
  }
  if (shared_.hub->client_count() >= kMaxClients) {
    ++shared_.counters->rejected["too many clients"];
    return Send(ErrorAnswer(
        503, "too many clients (limit " + std::to_string(kMaxClients) + "); try again later"));
  }
  std::make_shared<WsSession>(std::move(stream_), *shared_.hub, shared_.next_client_id++)
      ->Accept(parser_->get());
}

void HttpSession::Draw(Answer answer) {
  ++shared_.counters->snapshots;
  stream_.expires_never();  // no time limit while a picture is rendered
  const SnapshotRequest request = *answer.snapshot;
  auto done = [self = shared_from_this(), answer](SnapshotResult result) mutable {
    boost::asio::post(self->stream_.get_executor(), [self, answer = std::move(answer),
                                                     result = std::move(result)]() mutable {
      if (!result) return self->Send(ErrorAnswer(result.error().status, result.error().reason));
      answer.body.assign(result->begin(), result->end());
      self->Send(std::move(answer));
    });
  };
  if (shared_.snapshots != nullptr && shared_.snapshots->Submit(request, std::move(done))) return;
  ++shared_.counters->rejected["too many snapshots"];
  Answer busy = ErrorAnswer(503, "too many snapshots are being rendered; try again later");
  busy.headers.emplace_back("Retry-After", "1");
  Send(std::move(busy));
}

void HttpSession::Send(Answer answer) {
  const auto status = static_cast<bhttp::status>(answer.status);
  if (answer.file) {
    beast::error_code error;
    bhttp::file_body::value_type file;
    file.open(answer.file->c_str(), beast::file_mode::scan, error);
    if (error) return Send(ErrorAnswer(404, "the file no longer exists"));
    const std::uint64_t size = file.size();
    if (!is_head_) {
      auto response = std::make_shared<bhttp::response<bhttp::file_body>>(status, version_);
      AddHeaders(*response, answer);
      response->body() = std::move(file);
      response->content_length(size);
      return Write(std::move(response));
    }
    auto response = std::make_shared<bhttp::response<bhttp::empty_body>>(status, version_);
    AddHeaders(*response, answer);
    response->content_length(size);
    return Write(std::move(response));
  }
  if (is_head_ || answer.status == 304) {
    auto response = std::make_shared<bhttp::response<bhttp::empty_body>>(status, version_);
    AddHeaders(*response, answer);
    if (is_head_) response->content_length(answer.body.size());
    return Write(std::move(response));
  }
  auto response = std::make_shared<bhttp::response<bhttp::string_body>>(status, version_);
  AddHeaders(*response, answer);
  response->body() = std::move(answer.body);
  response->content_length(response->body().size());
  Write(std::move(response));
}

template <class Response>
void HttpSession::Write(std::shared_ptr<Response> response) {
  response->keep_alive(keep_alive_);
  stream_.expires_after(kWriteTimeout);
  bhttp::async_write(stream_, *response,
                     [self = shared_from_this(), response](beast::error_code error, std::size_t) {
                       if (error) return;
                       if (self->keep_alive_) return self->Read();
                       beast::error_code ignored;
                       self->stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send,
                                                       ignored);
                     });
}

}  // namespace kinescope::http
