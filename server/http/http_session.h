/// Serves one HTTP connection, with TLS if the server has a certificate: reads requests, sends
/// their answers, and becomes a WebSocket on request. A request is judged by its header; its body
/// is read only if the answer depends on it. Incoming data take at most the size of a header and a
/// body. Server's thread only.
#pragma once

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/system/ip_networks.h"
#include "server/http/answer.h"
#include "server/http/bucket.h"
#include "server/http/connections.h"
#include "server/http/counters.h"
#include "server/http/hub.h"
#include "server/http/incoming_request.h"
#include "server/http/pixel_budget.h"
#include "server/http/router.h"
#include "server/http/snapshot_worker.h"
#include "server/http/stream.h"
#include "server/http/tls_certificate.h"

namespace kinescope::http {

/// Objects shared by all connections; they outlive the connections.
struct Shared {
  std::function<Answer(const Request&)> route;  // of a request that asks for no WebSocket
  const Router* router = nullptr;               // null: there are no WebSockets, so no hub
  Hub* hub = nullptr;
  Counters* counters = nullptr;
  SnapshotWorker* snapshots = nullptr;  // null: no renderer
  PixelBudget* pixels = nullptr;
  TlsCertificate* tls = nullptr;  // null: the server does not encrypt
  IpNetworks proxies;             // whose X-Forwarded-* are believed
  std::string base_path;          // "" or "/lab3"
  PerAddress<Bucket> handshakes;  // that a client may still begin
  Connections connections;
  PatienceLimits patience;
  std::uint64_t next_client_id = 1;
};

class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  /// `address`: of the client, without port.
  HttpSession(boost::asio::ip::tcp::socket socket, std::string address, Shared& shared);
  ~HttpSession();
  HttpSession(const HttpSession&) = delete;
  HttpSession& operator=(const HttpSession&) = delete;

  void Read();

 private:
  using Parser = boost::beast::http::request_parser<boost::beast::http::string_body>;
  struct Response;

  void Greet();
  void ReadSome(void (HttpSession::*next)());
  void OnGreeting();
  [[nodiscard]] bool MayBeginTls();
  void ReadHeader();
  void Parse(void (HttpSession::*next)(boost::beast::error_code error));
  void ParseMore(void (HttpSession::*next)(boost::beast::error_code error));
  [[nodiscard]] boost::beast::error_code EndOfParsing();
  void OnHeader(boost::beast::error_code error);
  void SendToBasePath();
  void ReadBody();
  void WriteInterim(std::string_view rest);
  void ReadRest();
  void OnBody(boost::beast::error_code error);
  void Reject(const RequestDefect& defect);
  void RejectUnreadable(boost::beast::error_code error);
  void Enter(Connection::Phase phase);
  void Handle();
  void Respond();
  void BecomeWebSocket();
  void Draw(Answer answer);
  void WatchForEnd(const std::shared_ptr<std::atomic<bool>>& is_wanted);
  void WatchForReset(const std::shared_ptr<std::atomic<bool>>& is_wanted);
  void WatchForEndOfTls(const std::shared_ptr<std::atomic<bool>>& is_wanted);
  [[nodiscard]] bool SendContinue();
  void Send(Answer answer);
  void Write(const std::shared_ptr<Response>& response);
  void OnWriteFailed(boost::beast::error_code error);
  void OnWritten();
  void EndTls();
  void Discard(std::size_t bytes_left);

  Stream stream_;
  Shared& shared_;
  boost::beast::flat_buffer incoming_;
  std::optional<Parser> parser_;  // a new one per request
  Request request_;               // its header alone, so that trailers change nothing, and its body
  Connection connection_;         // as the others see it
  bool is_first_ = true;          // no request has been answered yet
  bool is_head_ = false;
  bool keep_alive_ = false;
  bool is_unread_ = false;   // the client may still send a part of the request
  bool is_plain_ = false;    // the client sends HTTP to a port with TLS
  bool is_watched_ = false;  // a read waits for the end of a TLS stream
  unsigned version_ = 11;
};

}  // namespace kinescope::http
