#include "server/http/local_server.h"

#include <optional>
#include <utility>

#include "server/http/access.h"
#include "server/http/plain_server.h"
#include "server/http/server.h"
#include "server/http/target.h"

namespace kinescope::http {
namespace {

constexpr char kLocalAddress[] = "127.0.0.1";
constexpr int kDefaultHttpPort = 80;  // browsers leave it out of Host

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
      : server(Listener(config), [this](const Request& request) { return Route(request); }) {}

  [[nodiscard]] bool IsOwnHost(const std::string& host) const;
  [[nodiscard]] std::optional<Answer> Refuse(const Request& request) const;
  [[nodiscard]] bool HasToken(const Request& request, const Target& target) const;
  Answer Route(const Request& request) const;

  const std::string token = RandomToken();
  Handler handler;
  PlainServer server;
};

bool LocalServer::Impl::IsOwnHost(const std::string& host) const {
  const int port = server.port();
  for (const std::string name : {kLocalAddress, "localhost"}) {
    if (host == name + ":" + std::to_string(port)) return true;
    if (port == kDefaultHttpPort && host == name) return true;
  }
  return false;
}

std::optional<Answer> LocalServer::Impl::Refuse(const Request& request) const {
  if (!IsOwnHost(request.host)) {
    const std::string port = std::to_string(server.port());
    return ErrorAnswer(
        403, "unknown host; only 127.0.0.1:" + port + " and localhost:" + port + " are served");
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
Answer LocalServer::Impl::Route(const Request& request) const {
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

int LocalServer::port() const { return impl_->server.port(); }

const std::string& LocalServer::token() const { return impl_->token; }

std::string LocalServer::url() const {
  return "http://" + std::string(kLocalAddress) + ":" + std::to_string(port()) +
         "/?token=" + impl_->token;
}

void LocalServer::Serve(const Handler& handler, const std::function<bool()>& is_over) {
  impl_->handler = handler;
  impl_->server.Serve(is_over);
}

}  // namespace kinescope::http
