#include "server/http/stream.h"

#include <boost/asio/ssl/stream.hpp>
#include <boost/beast/core/basic_stream.hpp>
#include <boost/beast/core/flat_stream.hpp>
#include <boost/beast/core/rate_policy.hpp>
#include <boost/beast/websocket/teardown.hpp>

namespace kinescope::http {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;

using LimitedTcp =
    beast::basic_stream<asio::ip::tcp, asio::any_io_executor, beast::simple_rate_policy>;

// Of an operation that ends without a number of bytes.
auto WithoutBytes(IoHandler handler) {
  return [handler = std::move(handler)](beast::error_code error) mutable { handler(error, 0); };
}

}  // namespace

// Also what TLS reads and writes.
class Stream::Tcp : public LimitedTcp {
 public:
  using LimitedTcp::LimitedTcp;

  template <class Buffers, class Handler>
  void async_read_some(const Buffers& buffers, Handler&& handler) {
    const asio::mutable_buffer buffer = *asio::buffer_sequence_begin(buffers);
    LimitedTcp::async_read_some(buffer, IoHandler(std::forward<Handler>(handler)));
  }
  template <class Buffers, class Handler>
  void async_write_some(const Buffers& buffers, Handler&& handler) {
    LimitedTcp::async_write_some(Outgoing(buffers), IoHandler(std::forward<Handler>(handler)));
  }
};

struct Stream::Tls {
  Tls(Tcp& tcp, asio::ssl::context& context) : flat(tcp, context) {}

  asio::ssl::stream<Tcp&>& stream() { return flat.next_layer(); }

  // The header of a message and its content are one record.
  beast::flat_stream<asio::ssl::stream<Tcp&>> flat;
};

Stream::Stream(asio::ip::tcp::socket socket) : tcp_(std::make_unique<Tcp>(std::move(socket))) {}

Stream::~Stream() = default;
Stream::Stream(Stream&&) noexcept = default;

void Stream::AsyncHandshake(asio::ssl::context& context, asio::const_buffer received,
                            IoHandler handler) {
  tls_ = std::make_unique<Tls>(*tcp_, context);
  tls_->stream().async_handshake(asio::ssl::stream_base::server, received, std::move(handler));
}

void Stream::AsyncShutdownTls(IoHandler handler) {
  tls_->stream().async_shutdown(WithoutBytes(std::move(handler)));
}

void Stream::AsyncReadSome(asio::mutable_buffer buffer, IoHandler handler) {
  if (tls_) return tls_->stream().async_read_some(buffer, std::move(handler));
  tcp_->async_read_some(buffer, std::move(handler));
}

void Stream::AsyncWriteSome(const Outgoing& parts, IoHandler handler) {
  if (tls_) return tls_->flat.async_write_some(parts, std::move(handler));
  tcp_->async_write_some(parts, std::move(handler));
}

void Stream::AsyncEnd(beast::role_type role, IoHandler handler) {
  if (tls_) return AsyncShutdownTls(std::move(handler));
  beast::websocket::async_teardown(role, tcp_->socket(), WithoutBytes(std::move(handler)));
}

Stream::executor_type Stream::get_executor() noexcept { return tcp_->get_executor(); }
asio::ip::tcp::socket& Stream::socket() { return tcp_->socket(); }
void Stream::LimitReading(std::size_t bytes_per_sec) {
  tcp_->rate_policy().read_limit(bytes_per_sec);
}
void Stream::ExpiresAt(Clock::time_point time) { tcp_->expires_at(time); }
void Stream::ExpiresNever() { tcp_->expires_never(); }
void Stream::Cancel() { tcp_->cancel(); }
void Stream::Close() { tcp_->close(); }

}  // namespace kinescope::http
