#include "server/http/http_session.h"

#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <boost/asio/error.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core/file.hpp>
#include <boost/beast/core/read_size.hpp>
#include <boost/beast/core/string.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <cerrno>
#include <exception>
#include <string_view>
#include <utility>

#include "server/http/base_path.h"
#include "server/http/response_head.h"
#include "server/http/without_tls.h"
#include "server/http/ws_session.h"

namespace kinescope::http {
namespace {

namespace beast = boost::beast;
namespace bhttp = boost::beast::http;

constexpr std::size_t kFirstBytes = 1024;
constexpr std::size_t kMaxDiscardedBytes = 64 << 10;
constexpr std::chrono::seconds kLongestDiscarding{1};
constexpr std::size_t kMinBytesPerWindow = 80'000;
constexpr std::uint64_t kFileBytesAtOnce = 64 << 10;
constexpr std::string_view kInterim = "HTTP/1.1 100 Continue\r\n\r\n";
constexpr char kTlsHandshake = 0x16;  // the first byte of a TLS client
// Each costs the server a millisecond; a browser begins six.
constexpr double kHandshakesAtOnce = 60, kHandshakesPerSecond = 10;

}  // namespace

// A response on its way.
struct HttpSession::Response {
  [[nodiscard]] bool IsSent() const { return sent == head.size() + content.size(); }
  [[nodiscard]] Outgoing Rest() const;
  [[nodiscard]] bool ReadFile();

  std::string head;     // status line and headers
  std::string content;  // of a file: the part that is sent now
  std::size_t sent = 0;
  beast::file file;
  std::uint64_t file_bytes_left = 0;  // that are not in `content` yet
  std::size_t window_bytes = 0;       // sent since the client was last given time
  Clock::time_point deadline{};       // for all of it
};

// What is not sent yet of head and content.
Outgoing HttpSession::Response::Rest() const {
  const std::size_t sent_content = sent - std::min(sent, head.size());
  return Outgoing(std::array<boost::asio::const_buffer, 2>{
      boost::asio::buffer(head) + sent, boost::asio::buffer(content) + sent_content});
}

// The next part of the file, when the one before is sent. False: the file is shorter than it was.
bool HttpSession::Response::ReadFile() {
  if (file_bytes_left == 0 || (!content.empty() && !IsSent())) return true;
  if (IsSent()) {
    head.clear();
    sent = 0;
  }
  content.resize(static_cast<std::size_t>(std::min(file_bytes_left, kFileBytesAtOnce)));
  beast::error_code error;
  content.resize(file.read(content.data(), content.size(), error));
  file_bytes_left -= content.size();
  return !content.empty();
}

HttpSession::HttpSession(boost::asio::ip::tcp::socket socket, std::string address, Shared& shared)
    : stream_(std::move(socket)), shared_(shared), incoming_(kMaxIncomingBytes) {
  connection_.address = std::move(address);
  connection_.opened = Clock::now();
  connection_.close = [this] { stream_.Close(); };
  shared_.connections.Add(connection_);
}

HttpSession::~HttpSession() { shared_.connections.Remove(connection_); }

void HttpSession::Read() {
  is_head_ = false;
  version_ = 11;
  parser_.emplace();
  parser_->header_limit(kMaxHeaderBytes);
  parser_->body_limit(kMaxBodyBytes);
  Enter(Connection::Phase::kWaiting);
  if (is_first_ && shared_.tls != nullptr) {
    is_first_ = false;
    return Greet();
  }
  if (std::exchange(is_first_, false) || incoming_.size() > 0) return ReadHeader();
  stream_.ExpiresAfter(shared_.patience.next_request);
  ReadSome(&HttpSession::ReadHeader);
}

// On a port with TLS. A client that begins with something else is read as one of HTTP, and told.
void HttpSession::Greet() {
  stream_.ExpiresAfter(shared_.patience.header);
  ReadSome(&HttpSession::OnGreeting);
}

// At least one byte, then `next`; nothing if the client is gone.
void HttpSession::ReadSome(void (HttpSession::*next)()) {
  stream_.AsyncReadSome(
      incoming_.prepare(kFirstBytes),
      [self = shared_from_this(), next](beast::error_code error, std::size_t bytes) {
        if (error) return;
        self->incoming_.commit(bytes);
        (*self.*next)();
      });
}

void HttpSession::OnGreeting() {
  is_plain_ = *static_cast<const char*>(incoming_.cdata().data()) != kTlsHandshake;
  if (is_plain_) return ReadHeader();
  if (!MayBeginTls()) {
    ++shared_.counters->rejected["too many TLS handshakes"];
    return;  // closed by its destructor
  }
  stream_.AsyncHandshake(*shared_.tls->context(), incoming_.cdata(),
                         [self = shared_from_this()](beast::error_code error, std::size_t used) {
                           if (error || used != self->incoming_.size()) {
                             ++self->shared_.counters->rejected["TLS handshake failed"];
                             return;
                           }
                           self->incoming_.clear();
                           self->ReadHeader();
                         });
}

bool HttpSession::MayBeginTls() {
  const auto now = Clock::now();
  Bucket& handshakes = shared_.handshakes.At(
      connection_.address, [&] { return Bucket(kHandshakesAtOnce, kHandshakesPerSecond, now); },
      [&](Bucket& bucket) { return bucket.IsFull(now); });
  if (handshakes.WaitFor(1, now).count() > 0) return false;
  handshakes.Take(1, now);
  return true;
}

void HttpSession::ReadHeader() {
  stream_.ExpiresAfter(shared_.patience.header);
  parser_->eager(false);
  Parse(&HttpSession::OnHeader);
}

// Until the parser has a header, or, if it is eager, a whole request; then `next`.
void HttpSession::Parse(void (HttpSession::*next)(beast::error_code error)) {
  beast::error_code error;
  while (parser_->eager() ? !parser_->is_done() : !parser_->is_header_done()) {
    error = bhttp::error::need_more;
    if (incoming_.size() > 0) incoming_.consume(parser_->put(incoming_.data(), error));
    if (error == bhttp::error::need_more) return ParseMore(next);
    if (error) break;
  }
  (this->*next)(error);
}

void HttpSession::ParseMore(void (HttpSession::*next)(beast::error_code error)) {
  const std::size_t room = beast::read_size(incoming_, kMaxIncomingBytes);
  if (room == 0) return (this->*next)(bhttp::error::buffer_overflow);
  stream_.AsyncReadSome(incoming_.prepare(room), [self = shared_from_this(), next](
                                                     beast::error_code error, std::size_t bytes) {
    self->incoming_.commit(bytes);
    if (!error) return self->Parse(next);
    if (error == boost::asio::error::eof) error = self->EndOfParsing();
    ((*self).*next)(error);
  });
}

// The client sends nothing more.
beast::error_code HttpSession::EndOfParsing() {
  if (!parser_->got_some()) return bhttp::error::end_of_stream;
  beast::error_code error;
  parser_->put_eof(error);
  return error;
}

void HttpSession::OnHeader(beast::error_code error) {
  if (error) return RejectUnreadable(error);
  const auto& request = parser_->get();
  is_head_ = request.method() == bhttp::verb::head;
  version_ = request.version();
  if (const auto defect = FindDefect(request)) return Reject(*defect);
  const bool has_body = !parser_->is_done();
  if (has_body && beast::websocket::is_upgrade(request)) {
    return Reject({400, "the request for a WebSocket has a body; send it without"});
  }
  beast::error_code gone;
  const auto peer = stream_.socket().remote_endpoint(gone).address();
  if (gone) return;
  request_ = ToRequest(request, peer, shared_.proxies, Clock::now());
  connection_.address = request_.address;
  if (!has_body) request_.body.emplace();
  // Most answers do not need the body: then it is not read, and nothing that follows it either.
  is_unread_ = has_body;
  keep_alive_ = !has_body && parser_->keep_alive();
  ++shared_.counters->requests;
  if (!is_plain_) {
    auto target = WithoutBasePath(request_.target, shared_.base_path);
    if (!target) return SendToBasePath();
    request_.target = *std::move(target);
  }
  Handle();
}

// "/lab3" is "/lab3/", with the query.
void HttpSession::SendToBasePath() {
  Answer answer = ErrorAnswer(308, "the page is at " + shared_.base_path + "/");
  answer.headers.emplace_back(
      "Location", shared_.base_path + "/" + request_.target.substr(shared_.base_path.size()));
  Send(std::move(answer));
}

void HttpSession::ReadBody() {
  // Some clients wait a second for this before they send a body.
  const bool is_awaited = version_ >= 11 && incoming_.size() == 0 &&
                          beast::iequals(parser_->get()[bhttp::field::expect], "100-continue");
  if (is_awaited && stream_.is_tls()) {
    stream_.ExpiresAfter(shared_.patience.body);
    return WriteInterim(kInterim);
  }
  if (is_awaited && !SendContinue()) return;
  ReadRest();
}

void HttpSession::WriteInterim(std::string_view rest) {
  stream_.AsyncWriteSome(
      Outgoing(boost::asio::const_buffer(rest.data(), rest.size())),
      [self = shared_from_this(), rest](beast::error_code error, std::size_t bytes) {
        if (error) return;
        if (bytes < rest.size()) return self->WriteInterim(rest.substr(bytes));
        self->ReadRest();
      });
}

void HttpSession::ReadRest() {
  stream_.ExpiresAfter(shared_.patience.body);
  parser_->eager(true);
  Parse(&HttpSession::OnBody);
}

void HttpSession::OnBody(beast::error_code error) {
  if (error) return RejectUnreadable(error);
  request_.body = std::move(parser_->get().body());
  is_unread_ = false;
  keep_alive_ = parser_->keep_alive();
  Handle();
}

void HttpSession::Enter(Connection::Phase phase) {
  connection_.phase = phase;
  connection_.since = Clock::now();
}

void HttpSession::Reject(const RequestDefect& defect) {
  is_unread_ = true;
  keep_alive_ = false;
  ++shared_.counters->rejected["bad request"];
  Send(ErrorAnswer(defect.status, defect.reason));
}

void HttpSession::RejectUnreadable(beast::error_code error) {
  if (const auto defect = FindDefect(error, parser_->get())) Reject(*defect);
}

void HttpSession::Handle() {
  try {
    Respond();
  } catch (const std::exception& failure) {
    ++shared_.counters->failures;
    Send(ErrorAnswer(500, failure.what()));
  }
}

void HttpSession::Respond() {
  if (is_plain_) {
    keep_alive_ = false;
    ++shared_.counters->rejected["no TLS"];
    return Send(AnswerWithoutTls(request_));
  }
  if (shared_.router != nullptr && beast::websocket::is_upgrade(parser_->get())) {
    return BecomeWebSocket();
  }
  Answer answer = shared_.route(request_);
  connection_.has_token = answer.to_token_holder;
  if (answer.needs_body) return ReadBody();
  if (answer.snapshot) return Draw(std::move(answer));
  Send(std::move(answer));
}

void HttpSession::BecomeWebSocket() {
  Role role = Role::kViewer;
  if (auto refusal = shared_.router->RefuseWebSocket(request_, &role)) {
    return Send(*std::move(refusal));
  }
  if (!shared_.hub->HasPlaceFor(connection_.address)) {
    ++shared_.counters->rejected["too many clients"];
    return Send(ErrorAnswer(503, shared_.hub->WhyNoPlaceFor(connection_.address)));
  }
  shared_.connections.Remove(connection_);
  ServeWebSocket(std::move(stream_), connection_.address, role, *shared_.hub,
                 shared_.next_client_id++, parser_->get());
}

void HttpSession::Draw(Answer answer) {
  const SnapshotRequest request = *answer.snapshot;
  const auto now = Clock::now();
  if (auto refusal = shared_.pixels->Refuse(connection_.address, request, now)) {
    ++shared_.counters->rejected["too many pixels"];
    return Send(*std::move(refusal));
  }
  const auto is_wanted = std::make_shared<std::atomic<bool>>(true);
  // The last reference to this session is let go on the server's thread.
  auto done = [self = shared_from_this(), answer](SnapshotResult result) mutable {
    const auto executor = self->stream_.get_executor();
    boost::asio::post(executor, [self = std::move(self), answer = std::move(answer),
                                 result = std::move(result)]() mutable {
      beast::error_code ignored;
      self->stream_.socket().cancel(ignored);  // stop watching
      if (!result && result.error().status == kAbandoned) return;
      if (!result) return self->Send(ErrorAnswer(result.error().status, result.error().reason));
      answer.body.assign(result->begin(), result->end());
      self->Send(std::move(answer));
    });
  };
  using Submission = SnapshotWorker::Submission;
  const auto submission =
      shared_.snapshots == nullptr
          ? Submission::kQueueFull
          : shared_.snapshots->Submit(connection_.address, request, is_wanted, std::move(done));
  if (submission == Submission::kQueued) {
    shared_.pixels->Pay(connection_.address, request, now);
    ++shared_.counters->snapshots;
    Enter(Connection::Phase::kDrawing);
    stream_.ExpiresNever();  // no time limit while a picture is rendered
    return stream_.is_tls() ? WatchForEndOfTls(is_wanted) : WatchForEnd(is_wanted);
  }
  ++shared_.counters->rejected["too many snapshots"];
  Answer busy = submission == Submission::kShareFull
                    ? ErrorAnswer(429, std::to_string(SnapshotWorker::kMaxWaitingPerAddress) +
                                           " snapshots of " + connection_.address +
                                           " wait already; try again when one has come")
                    : ErrorAnswer(503, std::to_string(SnapshotWorker::kMaxWaiting) +
                                           " snapshots wait already; try again later");
  busy.headers.emplace_back("Retry-After", "1");
  Send(std::move(busy));
}

// Until the picture is there: a client that has hung up needs none.
void HttpSession::WatchForEnd(const std::shared_ptr<std::atomic<bool>>& is_wanted) {
  stream_.socket().async_wait(boost::asio::ip::tcp::socket::wait_read,
                              [self = shared_from_this(), is_wanted](beast::error_code error) {
                                if (error) return;
                                char byte = 0;
                                const ssize_t count = ::recv(self->stream_.socket().native_handle(),
                                                             &byte, 1, MSG_PEEK | MSG_DONTWAIT);
                                if (count < 0 && errno == EAGAIN)
                                  return self->WatchForEnd(is_wanted);
                                if (count > 0) return;  // its next request
                                if (count == 0) return self->WatchForReset(is_wanted);
                                *is_wanted = false;
                                ++self->shared_.counters->rejected["abandoned"];
                              });
}

// Only a read shows what TLS has received, and it may still wait when the picture has been sent: so
// the connection ends then.
void HttpSession::WatchForEndOfTls(const std::shared_ptr<std::atomic<bool>>& is_wanted) {
  keep_alive_ = false;
  is_watched_ = true;
  stream_.AsyncReadSome(incoming_.prepare(kFirstBytes), [self = shared_from_this(), is_wanted](
                                                            beast::error_code error, std::size_t) {
    self->is_watched_ = false;
    if (!error || error == boost::asio::error::operation_aborted) return;
    *is_wanted = false;
    ++self->shared_.counters->rejected["abandoned"];
  });
}

// The client sends nothing more: it may have hung up, or wait for its picture. A byte tells: who
// has hung up resets the connection. HTTP/1.1 allows an interim response, HTTP/1.0 does not.
void HttpSession::WatchForReset(const std::shared_ptr<std::atomic<bool>>& is_wanted) {
  if (version_ < 11 || !SendContinue()) return;
  stream_.socket().async_wait(boost::asio::ip::tcp::socket::wait_error,
                              [self = shared_from_this(), is_wanted](beast::error_code error) {
                                if (error) return;
                                *is_wanted = false;
                                ++self->shared_.counters->rejected["abandoned"];
                              });
}

// The interim response, at once or not at all. False: the connection is closed, because a part of
// it would have spoilt the answer.
bool HttpSession::SendContinue() {
  const ssize_t sent = ::send(stream_.socket().native_handle(), kInterim.data(), kInterim.size(),
                              MSG_NOSIGNAL | MSG_DONTWAIT);
  const bool is_cut = sent >= 0 && sent < static_cast<ssize_t>(kInterim.size());
  if (is_cut) stream_.Close();
  return !is_cut;
}

void HttpSession::Send(Answer answer) {
  const auto response = std::make_shared<Response>();
  ResponseFraming framing;
  framing.version = version_;
  framing.keep_alive = keep_alive_;
  if (answer.file) {
    beast::error_code error;
    response->file.open(answer.file->c_str(), beast::file_mode::scan, error);
    if (!error) framing.content_length = response->file.size(error);
    if (error) return Send(ErrorAnswer(404, "the file no longer exists"));
    if (!is_head_) response->file_bytes_left = *framing.content_length;
  } else {
    if (is_head_ || answer.status != 304) framing.content_length = answer.body.size();
    if (!is_head_ && answer.status != 304) response->content = std::move(answer.body);
  }
  response->head = ResponseHead(answer, framing);
  Enter(Connection::Phase::kWriting);
  response->deadline = connection_.since + shared_.patience.response;
  stream_.ExpiresAt(
      std::min(response->deadline, connection_.since + shared_.patience.write_window));
  Write(response);
}

// A client that reads too slowly is disconnected: its response would stay in memory.
void HttpSession::Write(const std::shared_ptr<Response>& response) {
  if (!response->ReadFile()) return;  // the connection ends, as its client was promised more
  stream_.AsyncWriteSome(response->Rest(), [self = shared_from_this(), response](
                                               beast::error_code error, std::size_t bytes) {
    if (error) return self->OnWriteFailed(error);
    response->sent += bytes;
    if (response->IsSent() && response->file_bytes_left == 0) return self->OnWritten();
    const auto now = Clock::now();
    self->connection_.since = now;
    response->window_bytes += bytes;
    if (response->window_bytes >= kMinBytesPerWindow) {
      response->window_bytes = 0;
      self->stream_.ExpiresAt(
          std::min(response->deadline, now + self->shared_.patience.write_window));
    }
    self->Write(response);
  });
}

void HttpSession::OnWriteFailed(beast::error_code error) {
  if (error == beast::error::timeout) ++shared_.counters->rejected["response not read"];
}

void HttpSession::OnWritten() {
  if (keep_alive_) return Read();
  if (stream_.is_tls() && !is_watched_ && !is_unread_) return EndTls();
  beast::error_code ignored;
  stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
  if (!is_unread_) return;
  Enter(Connection::Phase::kWaiting);
  stream_.ExpiresAfter(kLongestDiscarding);
  Discard(kMaxDiscardedBytes);
}

// So that the client can tell the end from a connection that was cut.
void HttpSession::EndTls() {
  Enter(Connection::Phase::kWaiting);
  stream_.ExpiresAfter(kLongestDiscarding);
  stream_.AsyncShutdownTls([self = shared_from_this()](beast::error_code, std::size_t) {});
}

// Closing with unread bytes resets the connection: the client could lose the answer.
void HttpSession::Discard(std::size_t bytes_left) {
  incoming_.clear();
  stream_.AsyncReadSome(
      incoming_.prepare(kMaxBodyBytes),
      [self = shared_from_this(), bytes_left](beast::error_code error, std::size_t bytes) {
        if (!error && bytes < bytes_left) self->Discard(bytes_left - bytes);
      });
}

}  // namespace kinescope::http
