/// Answers HTTP requests by a function: no WebSockets, no pictures, no TLS. Sizes, times and number
/// of requests are limited as by HttpServer, whose sessions it uses: a slow or silent client blocks
/// no other.
#pragma once

#include <functional>
#include <memory>

#include "server/http/answer.h"

namespace kinescope::http {

class Listener;

class PlainServer {
 public:
  /// `route` is called on the thread of Serve(). What it throws ends the connection.
  using Route = std::function<Answer(const Request&)>;

  /// Takes the socket of `listener`.
  PlainServer(Listener&& listener, Route route);
  ~PlainServer();
  PlainServer(const PlainServer&) = delete;
  PlainServer& operator=(const PlainServer&) = delete;

  int port() const;

  /// Answers requests until `is_over`, which is called after each of them and ten times a second;
  /// then sends what is being sent, for two seconds at most. Call it once.
  void Serve(const std::function<bool()>& is_over);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kinescope::http
