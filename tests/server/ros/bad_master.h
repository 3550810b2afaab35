/// A ROS master, or anything that has its address, that sends what no master sends.
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>
#include <utility>

namespace kinescope::testing {

/// False once the other side has closed the connection.
inline bool Send(int connection, const std::string& text) {
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t count = send(connection, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
    if (count <= 0) return false;
    sent += static_cast<std::size_t>(count);
  }
  return true;
}

inline sockaddr_in Loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  return address;
}

inline std::string Nested(int depth) {
  std::string text;
  for (int i = 0; i < depth; ++i) text += "<value><array><data>";
  text += "<value><i4>1</i4></value>";
  for (int i = 0; i < depth; ++i) text += "</data></array></value>";
  return text;
}

inline std::string Answer(const std::string& value) {
  const std::string body = "<?xml version=\"1.0\"?><methodResponse><params><param>" + value +
                           "</param></params></methodResponse>";
  return "HTTP/1.1 200 OK\r\nContent-length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
}

/// Answers every request on a connection of its own, with what `reply` sends.
class BadMaster {
 public:
  using Reply = std::function<void(int connection, const std::string& request)>;

  explicit BadMaster(Reply reply, int port = 0) : reply_(std::move(reply)) {
    listener_ = socket(AF_INET, SOCK_STREAM, 0);
    const int on = 1;
    setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
    sockaddr_in address = Loopback(port);
    socklen_t size = sizeof(address);
    const auto* generic = reinterpret_cast<sockaddr*>(&address);
    EXPECT_EQ(bind(listener_, generic, size), 0);
    EXPECT_EQ(listen(listener_, 8), 0);
    getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { Serve(); });
  }
  ~BadMaster() {
    shutdown(listener_, SHUT_RDWR);
    thread_.join();
    close(listener_);
  }
  BadMaster(const BadMaster&) = delete;
  BadMaster& operator=(const BadMaster&) = delete;

  int port() const { return port_; }

 private:
  void Serve() {
    for (;;) {
      const int connection = accept(listener_, nullptr, nullptr);
      if (connection < 0) return;
      std::array<char, 4096> request;
      const ssize_t size = recv(connection, request.data(), request.size(), 0);
      reply_(connection,
             std::string(request.data(), size > 0 ? static_cast<std::size_t>(size) : 0));
      close(connection);
    }
  }

  const Reply reply_;
  int listener_ = -1;
  int port_ = 0;
  std::thread thread_;
};

}  // namespace kinescope::testing
