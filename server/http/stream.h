/// The connection of one client: TCP, and TLS on it if the server has a certificate. One class for
/// both, so that what reads and writes HTTP and WebSockets is compiled once. What a WebSocket
/// receives is limited to so many bytes per second, whatever these bytes are: then a flood of tiny
/// frames costs little. A stream of Beast (AsyncStream); its timer covers every operation. Server's
/// thread only.
#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/beast/core/basic_stream.hpp>
#include <boost/beast/core/error.hpp>
#include <boost/beast/core/flat_stream.hpp>
#include <boost/beast/core/rate_policy.hpp>
#include <boost/beast/core/role.hpp>
#include <boost/beast/websocket/teardown.hpp>
#include <memory>
#include <utility>

namespace kinescope::http {

class Stream {
 public:
  using Tcp = boost::beast::basic_stream<boost::asio::ip::tcp, boost::asio::any_io_executor,
                                         boost::beast::simple_rate_policy>;
  using executor_type = Tcp::executor_type;

  explicit Stream(boost::asio::ip::tcp::socket socket)
      : tcp_(std::make_unique<Tcp>(std::move(socket))) {}

  /// From here on TLS: `received` are the bytes that were read already. The handler receives an
  /// error and the number of bytes of `received` that were used. `context` need not live longer.
  template <class Buffers, class Handler>
  void AsyncHandshake(boost::asio::ssl::context& context, const Buffers& received,
                      Handler&& handler) {
    tls_ = std::make_unique<Tls>(*tcp_, context);
    tls_->next_layer().async_handshake(boost::asio::ssl::stream_base::server, received,
                                       std::forward<Handler>(handler));
  }
  [[nodiscard]] bool is_tls() const { return tls_ != nullptr; }
  /// Sends the end of a TLS stream, and waits for that of the client.
  template <class Handler>
  void AsyncShutdownTls(Handler&& handler) {
    tls_->next_layer().async_shutdown(std::forward<Handler>(handler));
  }

  executor_type get_executor() noexcept { return tcp_->get_executor(); }
  template <class Buffers, class Handler>
  void async_read_some(const Buffers& buffers, Handler&& handler) {
    if (tls_) return tls_->async_read_some(buffers, std::forward<Handler>(handler));
    tcp_->async_read_some(buffers, std::forward<Handler>(handler));
  }
  template <class Buffers, class Handler>
  void async_write_some(const Buffers& buffers, Handler&& handler) {
    if (tls_) return tls_->async_write_some(buffers, std::forward<Handler>(handler));
    tcp_->async_write_some(buffers, std::forward<Handler>(handler));
  }

  boost::asio::ip::tcp::socket& socket() { return tcp_->socket(); }
  boost::beast::simple_rate_policy& rate_policy() { return tcp_->rate_policy(); }
  template <class Time>
  void expires_after(Time time) {
    tcp_->expires_after(time);
  }
  template <class Time>
  void expires_at(Time time) {
    tcp_->expires_at(time);
  }
  void expires_never() { tcp_->expires_never(); }
  void cancel() { tcp_->cancel(); }
  void close() { tcp_->close(); }

  // What Beast looks for to end a WebSocket.
  friend void beast_close_socket(Stream& stream) { stream.close(); }
  template <class Handler>
  friend void async_teardown(boost::beast::role_type role, Stream& stream, Handler&& handler) {
    if (stream.tls_) return stream.AsyncShutdownTls(std::forward<Handler>(handler));
    using boost::beast::websocket::async_teardown;
    async_teardown(role, stream.tcp_->socket(), std::forward<Handler>(handler));
  }

 private:
  // Flat: the header of a message and its content are one record.
  using Tls = boost::beast::flat_stream<boost::asio::ssl::stream<Tcp&>>;

  // On the heap, because TLS refers to TCP and a stream can be moved.
  std::unique_ptr<Tcp> tcp_;
  std::unique_ptr<Tls> tls_;  // null: not yet, or never
};

}  // namespace kinescope::http
