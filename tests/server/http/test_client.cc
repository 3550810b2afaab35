#include "tests/server/http/test_client.h"

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <cstring>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "server/http/stream.h"
#include "tests/patience.h"

namespace kinescope::http::testing {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace bhttp = boost::beast::http;
namespace websocket = boost::beast::websocket;
using asio::ip::tcp;
using kinescope::testing::kPatience;
using Error = boost::system::error_code;

// Runs what was started on `io`, and nothing else, to its end.
void Finish(asio::io_context& io, const bool& done, const char* what) {
  io.restart();
  const auto until = std::chrono::steady_clock::now() + kPatience;
  while (!done && std::chrono::steady_clock::now() < until) io.run_one_until(until);
  if (!done) throw std::runtime_error(std::string("timed out: ") + what);
}

tcp::endpoint Local(int port) {
  return {asio::ip::address_v4::loopback(), static_cast<unsigned short>(port)};
}

void Connect(tcp::socket& socket, int port, int receive_buffer_bytes, const std::string& from) {
  socket.open(tcp::v4());
  if (!from.empty()) socket.bind({asio::ip::make_address(from), 0});
  if (receive_buffer_bytes > 0) {
    socket.set_option(asio::socket_base::receive_buffer_size(receive_buffer_bytes));
  }
  socket.connect(Local(port));
}

std::string Receive(asio::io_context& io, tcp::socket& socket, std::size_t enough,
                    const char* what) {
  std::string received;
  bool done = false;
  asio::async_read(socket, asio::dynamic_buffer(received), asio::transfer_at_least(enough),
                   [&](Error, std::size_t) { done = true; });
  Finish(io, done, what);
  return received;
}

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

std::string RequestText(int port, const std::string& target, const Headers& headers,
                        const std::string& method, const std::string& body) {
  std::string text = method + " " + target + " HTTP/1.1\r\n";
  Headers all = headers;
  all.emplace("Host", "127.0.0.1:" + std::to_string(port));
  all.emplace("Connection", "close");
  if (!body.empty()) all["Content-Length"] = std::to_string(body.size());
  for (const auto& [name, value] : all) text.append(name + ": " + value + "\r\n");
  return text + "\r\n" + body;
}

}  // namespace

Response Fetch(int port, const std::string& target, const Headers& headers,
               const std::string& method, const std::string& body, const std::string& from) {
  asio::io_context io;
  tcp::socket socket(io);
  Connect(socket, port, 0, from);
  Error failure;
  // The server may have answered before it has all.
  asio::write(socket, asio::buffer(RequestText(port, target, headers, method, body)), failure);
  bhttp::response_parser<bhttp::string_body> parser;
  parser.body_limit(64u << 20);
  parser.eager(true);
  parser.skip(method == "HEAD");
  beast::flat_buffer buffer;
  do {
    bool done = false;
    socket.async_read_some(buffer.prepare(64 << 10), [&](Error error, std::size_t bytes) {
      done = true;
      failure = error;
      buffer.commit(bytes);
    });
    Finish(io, done, target.c_str());
    if (!failure) buffer.consume(parser.put(buffer.data(), failure));
    if (failure == bhttp::error::need_more) failure = {};
  } while (!failure && !parser.is_done());
  if (failure) throw boost::system::system_error(failure, target);
  Response response;
  response.status = static_cast<int>(parser.get().result_int());
  for (const auto& field : parser.get()) {
    std::string name(field.name_string());
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    response.headers[name] = std::string(field.value());
  }
  response.body = parser.get().body();
  return response;
}

std::string Exchange(int port, const std::string& bytes, std::size_t enough) {
  asio::io_context io;
  tcp::socket socket(io);
  socket.connect(Local(port));
  Error ignored;
  asio::write(socket, asio::buffer(bytes), ignored);  // the server may hang up while we still talk
  return Receive(io, socket, enough, "an answer to raw bytes");
}

struct OpenConnection::Impl {
  asio::io_context io;
  tcp::socket socket{io};
};

OpenConnection::OpenConnection(int port, const std::string& bytes, int receive_buffer_bytes,
                               const std::string& from)
    : impl_(std::make_unique<Impl>()) {
  Connect(impl_->socket, port, receive_buffer_bytes, from);
  Send(bytes);
}

OpenConnection::~OpenConnection() = default;
OpenConnection::OpenConnection(OpenConnection&&) noexcept = default;
OpenConnection& OpenConnection::operator=(OpenConnection&&) noexcept = default;

void OpenConnection::Send(const std::string& bytes) {
  Error ignored;
  asio::write(impl_->socket, asio::buffer(bytes), ignored);
}

void OpenConnection::FinishSending() { impl_->socket.shutdown(tcp::socket::shutdown_send); }

std::string OpenConnection::Read(std::size_t enough) {
  return Receive(impl_->io, impl_->socket, enough, "a part of an answer");
}

std::string OpenConnection::ReadToEnd() {
  return Receive(impl_->io, impl_->socket, kAll, "the end of an answer");
}

struct WsClient::Impl {
  Impl(int port, int receive_buffer_bytes, const std::string& from) {
    tcp::socket connected(io);
    Connect(connected, port, receive_buffer_bytes, from);
    socket.emplace(std::move(connected));
  }

  // What `start` starts, to its end.
  template <class Start>
  Error Run(const char* what, Start start) {
    bool done = false;
    Error failure;
    start([&](Error error, std::size_t = 0) {
      done = true;
      failure = error;
    });
    Finish(io, done, what);
    return failure;
  }

  void Write(const std::string& bytes) {
    const Error failure = Run(
        "sending", [&](auto then) { socket->async_write(asio::buffer(bytes), std::move(then)); });
    if (failure) throw boost::system::system_error(failure, "sending");
  }

  asio::io_context io;
  // As the server's, so that its operations are compiled once.
  std::optional<websocket::stream<Stream, /*deflateSupported=*/false>> socket;
  std::string protocol;
};

WsClient::WsClient(int port, const std::string& target, const Headers& headers,
                   int receive_buffer_bytes, const std::string& from)
    : impl_(std::make_unique<Impl>(port, receive_buffer_bytes, from)) {
  impl_->socket->set_option(
      websocket::stream_base::decorator([&](websocket::request_type& request) {
        for (const auto& [name, value] : headers) request.set(name, value);
      }));
  impl_->socket->read_message_max(0);  // no limit: a test may send itself something huge
  websocket::response_type response;
  const Error failure = impl_->Run("the WebSocket handshake", [&](auto then) {
    impl_->socket->async_handshake(response, "127.0.0.1:" + std::to_string(port), target,
                                   std::move(then));
  });
  if (failure) throw std::runtime_error("refused: " + std::to_string(response.result_int()));
  impl_->protocol = std::string(response[bhttp::field::sec_websocket_protocol]);
}

const std::string& WsClient::protocol() const { return impl_->protocol; }

WsClient::~WsClient() = default;

std::uint64_t WsClient::Message::state_number() const {
  double number = 0;
  std::memcpy(&number, bytes.data() + 8, sizeof number);
  return static_cast<std::uint64_t>(number);
}

WsClient::Message WsClient::Receive() {
  beast::flat_buffer buffer;
  const Error failure = impl_->Run(
      "a message", [&](auto then) { impl_->socket->async_read(buffer, std::move(then)); });
  if (failure) throw boost::system::system_error(failure, "receiving");
  const auto* const begin = static_cast<const std::uint8_t*>(buffer.cdata().data());
  return {impl_->socket->got_text(), {begin, begin + buffer.size()}};
}

WsClient::Message WsClient::ReceiveState() {
  while (true) {
    Message message = Receive();
    if (message.IsState()) return message;
  }
}

WsClient::Message WsClient::ReceivePicture() {
  while (true) {
    Message message = Receive();
    if (message.IsPicture()) return message;
  }
}

WsClient::Message WsClient::ReceivePast() {
  while (true) {
    Message message = Receive();
    if (message.IsPast()) return message;
  }
}

nlohmann::json WsClient::ReceiveText(const std::string& key) {
  while (true) {
    const Message message = Receive();
    if (!message.is_text) continue;
    nlohmann::json document = message.json();
    if (document.contains(key)) return document;
  }
}

bool WsClient::WaitForClose() {
  const auto until = std::chrono::steady_clock::now() + kPatience;
  try {
    while (std::chrono::steady_clock::now() < until) Receive();
    return false;
  } catch (const boost::system::system_error&) {
    return true;
  }
}

void WsClient::Send(const std::string& text) {
  impl_->socket->text(true);
  impl_->Write(text);
}

void WsClient::SendBinary(const std::string& bytes) {
  impl_->socket->binary(true);
  impl_->Write(bytes);
}

void WsClient::SendPing() {
  (void)impl_->Run("a ping", [&](auto then) { impl_->socket->async_ping({}, std::move(then)); });
}

void WsClient::SendPong() {
  (void)impl_->Run("a pong", [&](auto then) { impl_->socket->async_pong({}, std::move(then)); });
}

void WsClient::SendRaw(const std::string& bytes) {
  asio::write(impl_->socket->next_layer().socket(), asio::buffer(bytes));
}

}  // namespace kinescope::http::testing
