/// Serves one HTTP connection: reads requests, sends the answers of the router, and becomes a
/// WebSocket on request. Server's thread only.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <cstdint>
#include <memory>
#include <optional>

#include "server/http/answer.h"
#include "server/http/counters.h"
#include "server/http/hub.h"
#include "server/http/router.h"
#include "server/http/snapshot_worker.h"

namespace kinescope::http {

/// Objects shared by all connections; they outlive the connections.
struct Shared {
  const Router* router = nullptr;
  Hub* hub = nullptr;
  Counters* counters = nullptr;
  SnapshotWorker* snapshots = nullptr;  // null: no renderer
  int connections = 0;
  std::uint64_t next_client_id = 1;
};

class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(boost::asio::ip::tcp::socket socket, Shared& shared);
  ~HttpSession();
  HttpSession(const HttpSession&) = delete;
  HttpSession& operator=(const HttpSession&) = delete;

  void Read();

 private:
  using Parser = boost::beast::http::request_parser<boost::beast::http::string_body>;

  void OnRead(boost::beast::error_code error);
  void Handle();
  void BecomeWebSocket();
  void Draw(Answer answer);
  void Send(Answer answer);
  template <class Response>
  void Write(std::shared_ptr<Response> response);

  boost::beast::tcp_stream stream_;
  Shared& shared_;
  boost::beast::flat_buffer incoming_;
  std::optional<Parser> parser_;  // a new one per request
  bool is_head_ = false;
  bool keep_alive_ = false;
  unsigned version_ = 11;
};

}  // namespace kinescope::http
