/// The connection of one client: TCP, and TLS on it if the server has a certificate. What a
/// WebSocket receives is limited to so many bytes per second, whatever these bytes are: then a
/// flood of tiny frames costs little. One timer covers every operation. Server's thread only.
///
/// A stream of Beast (AsyncStream) that hides what it is made of, buffers and handlers included:
/// they all become one type, so that reading and writing are compiled once, in stream.cc.
#pragma once

#include <array>
#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/beast/core/error.hpp>
#include <boost/beast/core/role.hpp>
#include <chrono>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>

namespace kinescope::http {

/// What is called once, at the end of an operation, with its error and the number of bytes.
class IoHandler {
 public:
  template <class Handler,
            class = std::enable_if_t<!std::is_same_v<std::decay_t<Handler>, IoHandler>>>
  IoHandler(Handler&& handler)  // NOLINT(google-explicit-constructor): as std::function
      : call_(std::make_unique<Call<std::decay_t<Handler>>>(std::forward<Handler>(handler))) {}

  void operator()(boost::beast::error_code error, std::size_t bytes) { (*call_)(error, bytes); }

 private:
  struct AnyCall {
    virtual ~AnyCall() = default;
    virtual void operator()(boost::beast::error_code error, std::size_t bytes) = 0;
  };
  template <class Handler>
  struct Call final : AnyCall {
    explicit Call(Handler&& h) : handler(std::move(h)) {}
    explicit Call(const Handler& h) : handler(h) {}
    void operator()(boost::beast::error_code error, std::size_t bytes) override {
      handler(error, bytes);
    }
    Handler handler;
  };

  std::unique_ptr<AnyCall> call_;
};

/// What is sent next, in order: the header of a message and its content. A sequence of Asio
/// (ConstBufferSequence).
class Outgoing {
 public:
  using value_type = boost::asio::const_buffer;
  using const_iterator = const value_type*;

  /// The first parts of `buffers`: the rest is sent by the next write.
  template <class Buffers>
  explicit Outgoing(const Buffers& buffers) {
    const auto end = boost::asio::buffer_sequence_end(buffers);
    for (auto part = boost::asio::buffer_sequence_begin(buffers); part != end; ++part) {
      const value_type buffer = *part;
      if (buffer.size() == 0) continue;
      if (count_ == parts_.size()) return;
      parts_[count_++] = buffer;
    }
  }

  const_iterator begin() const { return parts_.data(); }
  const_iterator end() const { return parts_.data() + count_; }

 private:
  std::array<value_type, 4> parts_;
  std::size_t count_ = 0;
};

class Stream {
 public:
  using executor_type = boost::asio::any_io_executor;
  using Clock = std::chrono::steady_clock;

  explicit Stream(boost::asio::ip::tcp::socket socket);
  ~Stream();
  Stream(Stream&&) noexcept;

  /// From here on TLS: `received` are the bytes that were read already. The handler receives the
  /// number of bytes of `received` that were used. `context` need not live longer.
  void AsyncHandshake(boost::asio::ssl::context& context, boost::asio::const_buffer received,
                      IoHandler handler);
  [[nodiscard]] bool is_tls() const { return tls_ != nullptr; }
  /// Sends the end of a TLS stream, and waits for that of the client.
  void AsyncShutdownTls(IoHandler handler);

  void AsyncReadSome(boost::asio::mutable_buffer buffer, IoHandler handler);
  void AsyncWriteSome(const Outgoing& parts, IoHandler handler);

  boost::asio::ip::tcp::socket& socket();
  void LimitReading(std::size_t bytes_per_sec);
  void ExpiresAt(Clock::time_point time);
  void ExpiresAfter(Clock::duration time) { ExpiresAt(Clock::now() + time); }
  void ExpiresNever();
  void Cancel();
  void Close();

  // What Beast looks for.
  executor_type get_executor() noexcept;
  template <class Buffers, class Handler>
  void async_read_some(const Buffers& buffers, Handler&& handler) {
    AsyncReadSome(*boost::asio::buffer_sequence_begin(buffers), std::forward<Handler>(handler));
  }
  template <class Buffers, class Handler>
  void async_write_some(const Buffers& buffers, Handler&& handler) {
    AsyncWriteSome(Outgoing(buffers), std::forward<Handler>(handler));
  }
  friend void beast_close_socket(Stream& stream) { stream.Close(); }
  template <class Handler>
  friend void async_teardown(boost::beast::role_type role, Stream& stream, Handler&& handler) {
    stream.AsyncEnd(
        role, [handler = std::forward<Handler>(handler)](boost::beast::error_code error,
                                                         std::size_t) mutable { handler(error); });
  }

 private:
  class Tcp;
  struct Tls;

  void AsyncEnd(boost::beast::role_type role, IoHandler handler);  // of a WebSocket

  // On the heap, because TLS refers to TCP and a stream can be moved.
  std::unique_ptr<Tcp> tcp_;
  std::unique_ptr<Tls> tls_;  // null: not yet, or never
};

}  // namespace kinescope::http
