/// A TCP port of this computer for tests of clients of web servers.
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <functional>
#include <string>
#include <thread>
#include <utility>

namespace kinescope::testing {

class WebListener {
 public:
  /// @param answer  called with each client, one after the other, on a thread of its own; what it
  ///   uses must outlive this
  explicit WebListener(std::function<void(int client)> answer) : answer_(std::move(answer)) {
    socket_ = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const any = reinterpret_cast<sockaddr*>(&address);
    if (bind(socket_, any, size) != 0 || listen(socket_, 8) != 0) ADD_FAILURE() << "no socket";
    getsockname(socket_, any, &size);
    url_ = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port));
    thread_ = std::thread([this] {
      for (int client = -1; (client = accept(socket_, nullptr, nullptr)) >= 0; close(client)) {
        answer_(client);
      }
    });
  }
  ~WebListener() {
    shutdown(socket_, SHUT_RDWR);
    thread_.join();
    close(socket_);
  }
  WebListener(const WebListener&) = delete;
  WebListener& operator=(const WebListener&) = delete;

  const std::string& url() const { return url_; }

 private:
  const std::function<void(int client)> answer_;
  int socket_ = -1;
  std::string url_;
  std::thread thread_;
};

}  // namespace kinescope::testing
