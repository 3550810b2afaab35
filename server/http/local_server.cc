#include "server/http/local_server.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <exception>
#include <optional>
#include <utility>

#include "server/http/access.h"
#include "server/http/counters.h"
#include "server/http/http_session.h"
#include "server/http/server.h"
#include "server/http/target.h"

namespace kinescope::http {
namespace {

constexpr char kLocalAddress[] = "127.0.0.1";
constexpr int kDefaultHttpPort = 80;  // browsers leave it out of Host
constexpr std::chrono::milliseconds kLook{100};
constexpr std::chrono::seconds kLastAnswers{2};
constexpr std::chrono::milliseconds kAcceptPause{100};

HttpConfig LocalConfig(int port, const std::string& port_origin) {
  HttpConfig config;
  config.bind_ip = kLocalAddress;
  config.port = port;
  config.port_origin = port_origin;
  return config;
}

}  // namespace

struct LocalServer::Impl {
  explicit Impl(const HttpConfig& config)
      : acceptor(io, boost::asio::ip::tcp::v4(), Listener(config).Release()),
        port(acceptor.local_endpoint().port()) {
    shared.counters = &counters;
  }

  void Accept();
  void RunOne();
  [[nodiscard]] bool IsOwnHost(const std::string& host) const;
  [[nodiscard]] std::optional<Answer> Refuse(const Request& request) const;
  [[nodiscard]] bool HasToken(const Request& request, const Target& target) const;
  Answer Route(const Request& request, const Handler& handler) const;

  const std::string token = RandomToken();
  // Before io, so that they outlive the sessions that io still holds when it is destroyed.
  Counters counters;
  Shared shared;
  boost::asio::io_context io{1};
  boost::asio::ip::tcp::acceptor acceptor;
  boost::asio::steady_timer accept_pause{io};
  const int port;
};

void LocalServer::Impl::Accept() {
  acceptor.async_accept(
      [this](boost::system::error_code error, boost::asio::ip::tcp::socket socket) {
        if (error == boost::asio::error::operation_aborted) return;
        if (error) {  // probably out of file descriptors
          accept_pause.expires_after(kAcceptPause);
          return accept_pause.async_wait([this](boost::system::error_code cancelled) {
            if (!cancelled) Accept();
          });
        }
        Accept();
        if (!shared.connections.MakeRoomFor(kLocalAddress, Clock::now())) return;
        std::make_shared<HttpSession>(std::move(socket), kLocalAddress, shared)->Read();
      });
}

// What one connection cannot do (out of memory, for example) ends that connection.
void LocalServer::Impl::RunOne() {
  try {
    io.run_one_for(kLook);
  } catch (const std::exception&) {
    ++counters.failures;
  }
}

bool LocalServer::Impl::IsOwnHost(const std::string& host) const {
  for (const std::string name : {kLocalAddress, "localhost"}) {
    if (host == name + ":" + std::to_string(port)) return true;
    if (port == kDefaultHttpPort && host == name) return true;
  }
  return false;
}

std::optional<Answer> LocalServer::Impl::Refuse(const Request& request) const {
  if (!IsOwnHost(request.host)) {
    return ErrorAnswer(403, "unknown host; only 127.0.0.1:" + std::to_string(port) +
                                " and localhost:" + std::to_string(port) + " are served");
  }
  const bool is_foreign = !request.origin.empty() && request.origin != "http://" + request.host;
  if (is_foreign || (request.method == "POST" && IsFromAnotherSite(request.sec_fetch_site))) {
    return ErrorAnswer(403, "the request comes from the page of another site");
  }
  return std::nullopt;
}

bool LocalServer::Impl::HasToken(const Request& request, const Target& target) const {
  GivenTokens given = FindTokens(target, request.authorization, "", "");
  if (request.method == "POST") given.query.reset();
  return CheckToken({token, ""}, given).access != Access::kDenied;
}

// A POST is judged before its body is read.
Answer LocalServer::Impl::Route(const Request& request, const Handler& handler) const {
  if (auto refusal = Refuse(request)) return *std::move(refusal);
  const bool is_post = request.method == "POST";
  if (!is_post && request.method != "GET" && request.method != "HEAD") {
    Answer answer = ErrorAnswer(405, "unknown method; expected GET, HEAD or POST");
    answer.headers.emplace_back("Allow", "GET, HEAD, POST");
    return answer;
  }
  const auto target = ParseTarget(request.target);
  if (!target) return ErrorAnswer(400, target.error());
  if (!HasToken(request, *target)) {
    return ErrorAnswer(401,
                       "no token or a wrong one; open the URL that the command has printed, which "
                       "ends with ?token=...");
  }
  if (is_post && !request.body) return AskForBody();
  Answer answer = handler({is_post, target->path, is_post ? *request.body : ""});
  answer.to_token_holder = true;
  return answer;
}

LocalServer::LocalServer(int port, const std::string& port_origin)
    : impl_(std::make_unique<Impl>(LocalConfig(port, port_origin))) {}

LocalServer::~LocalServer() = default;

int LocalServer::port() const { return impl_->port; }

const std::string& LocalServer::token() const { return impl_->token; }

std::string LocalServer::url() const {
  return "http://" + std::string(kLocalAddress) + ":" + std::to_string(impl_->port) +
         "/?token=" + impl_->token;
}

void LocalServer::Serve(const Handler& handler, const std::function<bool()>& is_over) {
  impl_->shared.route = [&](const Request& request) { return impl_->Route(request, handler); };
  impl_->Accept();
  while (!is_over()) impl_->RunOne();
  boost::system::error_code ignored;
  impl_->acceptor.close(ignored);
  const auto until = Clock::now() + kLastAnswers;
  while (impl_->shared.connections.CountBusy() > 0 && Clock::now() < until) impl_->RunOne();
}

}  // namespace kinescope::http
