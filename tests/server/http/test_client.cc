#include "tests/server/http/test_client.h"

#include <algorithm>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <cstring>
#include <stdexcept>

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

}  // namespace

Response Fetch(int port, const std::string& target, const Headers& headers,
               const std::string& method, const std::string& body, const std::string& from) {
  asio::io_context io;
  beast::tcp_stream stream(io);
  Connect(stream.socket(), port, 0, from);
  bhttp::request<bhttp::string_body> request;
  request.version(11);
  request.method_string(method);
  request.target(target);
  request.set(bhttp::field::host, "127.0.0.1:" + std::to_string(port));
  request.set(bhttp::field::connection, "close");
  for (const auto& [name, value] : headers) request.set(name, value);
  request.body() = body;
  if (!body.empty()) request.content_length(body.size());
  bhttp::write(stream, request);
  bhttp::response_parser<bhttp::string_body> parser;
  parser.body_limit(64u << 20);
  parser.skip(method == "HEAD");
  beast::flat_buffer buffer;
  bool done = false;
  Error failure;
  bhttp::async_read(stream, buffer, parser, [&](Error error, std::size_t) {
    done = true;
    failure = error;
  });
  Finish(io, done, target.c_str());
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
  std::string answer;
  bool done = false;
  asio::async_read(socket, asio::dynamic_buffer(answer), asio::transfer_at_least(enough),
                   [&](Error, std::size_t) { done = true; });
  Finish(io, done, "an answer to raw bytes");
  return answer;
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

std::string OpenConnection::ReadToEnd() {
  std::string answer;
  bool done = false;
  asio::async_read(impl_->socket, asio::dynamic_buffer(answer),
                   [&](Error, std::size_t) { done = true; });
  Finish(impl_->io, done, "the end of a connection");
  return answer;
}

struct WsClient::Impl {
  asio::io_context io;
  websocket::stream<beast::tcp_stream> socket{io};
  std::string protocol;
};

WsClient::WsClient(int port, const std::string& target, const Headers& headers,
                   int receive_buffer_bytes, const std::string& from)
    : impl_(std::make_unique<Impl>()) {
  Connect(beast::get_lowest_layer(impl_->socket).socket(), port, receive_buffer_bytes, from);
  impl_->socket.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
    for (const auto& [name, value] : headers) request.set(name, value);
  }));
  impl_->socket.read_message_max(0);  // no limit: a test may send itself something huge
  websocket::response_type response;
  bool done = false;
  Error failure;
  impl_->socket.async_handshake(response, "127.0.0.1:" + std::to_string(port), target,
                                [&](Error error) {
                                  done = true;
                                  failure = error;
                                });
  Finish(impl_->io, done, "the WebSocket handshake");
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
  bool done = false;
  Error failure;
  impl_->socket.async_read(buffer, [&](Error error, std::size_t) {
    done = true;
    failure = error;
  });
  Finish(impl_->io, done, "a message");
  if (failure) throw boost::system::system_error(failure, "receiving");
  const auto* const begin = static_cast<const std::uint8_t*>(buffer.cdata().data());
  return {impl_->socket.got_text(), {begin, begin + buffer.size()}};
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
  impl_->socket.text(true);
  impl_->socket.write(asio::buffer(text));
}

void WsClient::SendBinary(const std::string& bytes) {
  impl_->socket.binary(true);
  impl_->socket.write(asio::buffer(bytes));
}

void WsClient::SendPing() { impl_->socket.ping({}); }
void WsClient::SendPong() { impl_->socket.pong({}); }

void WsClient::SendRaw(const std::string& bytes) {
  asio::write(beast::get_lowest_layer(impl_->socket).socket(), asio::buffer(bytes));
}

}  // namespace kinescope::http::testing
