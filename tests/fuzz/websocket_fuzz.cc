// Any bytes as what a client sends after the upgrade to a WebSocket, into the session of the server
// over a pair of sockets: the session ends with the connection, it has left the hub then, and every
// frame that it sent is a whole one that a client may receive.
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/http/field.hpp>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "core/system/check.h"
#include "server/http/ws_session.h"

namespace websocket_fuzz {
namespace {

using namespace kinescope;

// Of one second, see the limit of bytes in ws_session.cc: the session then never waits for time.
constexpr std::size_t kMaxBytes = 32 << 10;

class CountingFeed : public http::PictureFeed {
 public:
  void SetViewers(int count) override { viewers = count; }
  bool SetCamera(const std::string& camera) override { return camera == "front"; }
  void SetDark(bool) override {}
  std::vector<std::uint8_t> SnapshotPng(const http::SnapshotRequest&) override { return {}; }

  int viewers = 0;
};

http::IncomingRequest UpgradeRequest() {
  namespace bhttp = boost::beast::http;
  http::IncomingRequest request{bhttp::verb::get, "/api/v1/ws", 11};
  request.set(bhttp::field::host, "localhost");
  request.set(bhttp::field::upgrade, "websocket");
  request.set(bhttp::field::connection, "upgrade");
  request.set(bhttp::field::sec_websocket_key, "dGhlIHNhbXBsZSBub25jZQ==");
  request.set(bhttp::field::sec_websocket_version, "13");
  return request;
}

// Reads what the server has sent so far; false at its end, or if there is nothing more now.
bool Drain(int socket, std::string& received) {
  std::array<char, 65536> bytes;
  const ssize_t count = ::recv(socket, bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (count <= 0) return false;
  received.append(bytes.data(), static_cast<std::size_t>(count));
  return true;
}

std::uint64_t BigEndian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (const char byte : bytes) value = value << 8 | static_cast<std::uint8_t>(byte);
  return value;
}

// A message may be cut short where the connection ended, and only there.
void CheckFrames(std::string_view frames) {
  while (frames.size() >= 2) {
    const auto first = static_cast<std::uint8_t>(frames[0]);
    const auto second = static_cast<std::uint8_t>(frames[1]);
    const unsigned opcode = first & 0x0Fu;
    KINESCOPE_CHECK((first & 0xF0u) == 0x80u);  // one message, one frame; no extension
    KINESCOPE_CHECK(opcode == 1 || opcode == 2 || opcode == 8 || opcode == 9 || opcode == 10);
    KINESCOPE_CHECK(second < 128);  // a server sends without a mask
    const std::size_t more = second == 126 ? 2 : second == 127 ? 8 : 0;
    if (frames.size() < 2 + more) return;
    const std::uint64_t size = more > 0 ? BigEndian(frames.substr(2, more)) : second;
    frames.remove_prefix(2 + more);
    if (frames.size() < size) return;
    const std::string_view payload = frames.substr(0, size);
    if (opcode == 1) KINESCOPE_CHECK(nlohmann::json::parse(payload).is_object());
    KINESCOPE_CHECK(opcode < 8 || size < 126);
    frames.remove_prefix(size);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::array<int, 2> sockets{};
  KINESCOPE_CHECK(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, sockets.data()) == 0);
  Latest<SceneState> states;
  Latest<http::Picture> pictures;
  CountingFeed feed;
  http::Counters counters;
  http::Hub hub(states, pictures, &feed, nullptr, "iso", counters);
  boost::asio::io_context io{1};
  std::string received;
  const auto run = [&] {
    std::size_t handled = 0;
    bool has_read = false;
    do {
      io.restart();
      handled = io.poll();
      has_read = Drain(sockets[1], received);
    } while (handled > 0 || has_read);
  };
  {
    boost::asio::ip::tcp::socket socket(io);
    socket.assign(boost::asio::ip::tcp::v4(), sockets[0]);
    http::ServeWebSocket(http::Stream(std::move(socket)), "127.0.0.1", http::Role::kOperator, hub,
                         1, UpgradeRequest());
  }
  run();
  KINESCOPE_CHECK(hub.client_count() == 1);
  const std::size_t sent = std::min(size, kMaxBytes);
  KINESCOPE_CHECK(::send(sockets[1], data, sent, MSG_NOSIGNAL) == static_cast<ssize_t>(sent));
  hub.SendState(http::Hub::Clock::now());
  run();
  ::shutdown(sockets[1], SHUT_WR);
  run();
  KINESCOPE_CHECK(hub.client_count() == 0);
  KINESCOPE_CHECK(feed.viewers == 0);
  ::close(sockets[1]);
  const std::size_t body = received.find("\r\n\r\n");
  KINESCOPE_CHECK(received.rfind("HTTP/1.1 101", 0) == 0 && body != std::string::npos);
  CheckFrames(std::string_view(received).substr(body + 4));
  return 0;
}

}  // namespace websocket_fuzz
