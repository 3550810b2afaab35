/// Serves a page to the browser of the person who has started a command on this machine: HTTP on
/// 127.0.0.1, while Serve() runs. Other users of the machine and, through the person's browser,
/// foreign sites can reach the port, too. So a request gets an answer only if
///  - its Host is 127.0.0.1 or localhost with this port, which a foreign site that resolves its own
///    name to 127.0.0.1 (DNS rebinding) does not send,
///  - its Origin, if it has one, is this server,
///  - it has the token, 128 random bits that only url() has: a GET in the query or the header
///    Authorization, a POST in the header, which only our page can set.
/// Only POST may change anything. Sizes, times and number of requests are limited as by HttpServer,
/// whose sessions it uses: a slow or silent client blocks no other. One thread.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "server/http/answer.h"

namespace kinescope::http {

/// A request that has passed these checks.
struct LocalRequest {
  bool is_post = false;
  std::string path;  // decoded, without query
  std::string body;  // of a POST
};

class LocalServer {
 public:
  using Handler = std::function<Answer(const LocalRequest&)>;

  /// Listens. `port`: 0 is a free one. `port_origin`: the option that has set it, for messages.
  /// @throws UsageError with port, reason and remedy.
  LocalServer(int port, const std::string& port_origin);
  ~LocalServer();
  LocalServer(const LocalServer&) = delete;
  LocalServer& operator=(const LocalServer&) = delete;

  int port() const;
  const std::string& token() const;
  /// Of the page, with the token.
  std::string url() const;

  /// Answers requests until `is_over`, which is called after each of them and ten times a second;
  /// then sends what is being sent. `handler` may throw: its client gets the reason, with status
  /// 500.
  void Serve(const Handler& handler, const std::function<bool()>& is_over);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kinescope::http
