/// A web server for tests with a few fixed answers, on a free port of the loopback interface.
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

namespace kinescope::testing {

class SmallWebServer {
 public:
  struct Answer {
    std::string status;  // "200 OK", with more header lines after it
    std::string type, body;
  };

  /// `answers` by path; all else is not found. In a body, {count} is the number of answers so far.
  explicit SmallWebServer(std::map<std::string, Answer> answers)
      : answers_(std::move(answers)), listener_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    auto* generic = reinterpret_cast<sockaddr*>(&address);
    const bool is_listening = listener_ >= 0 && ::bind(listener_, generic, size) == 0 &&
                              ::listen(listener_, 16) == 0 &&
                              ::getsockname(listener_, generic, &size) == 0;
    if (!is_listening) throw std::runtime_error("no web server on the loopback");
    url_ = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port));
    thread_ = std::thread([this] { Serve(); });
  }
  ~SmallWebServer() {
    ::shutdown(listener_, SHUT_RDWR);  // which ends accept()
    thread_.join();
    ::close(listener_);
  }
  SmallWebServer(const SmallWebServer&) = delete;
  SmallWebServer& operator=(const SmallWebServer&) = delete;

  const std::string& url() const { return url_; }  // without a slash at the end

 private:
  // One connection after the other; one that says nothing, as browsers open them, is given up soon.
  void Serve() {
    while (true) {
      const int client = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
      if (client < 0) return;
      const timeval patience = {0, 200'000};
      ::setsockopt(client, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
      AnswerTo(client);
      ::close(client);
    }
  }

  void AnswerTo(int client) {
    std::string request;
    std::array<char, 4096> buffer{};
    while (request.find("\r\n\r\n") == std::string::npos) {
      const ssize_t count = ::recv(client, buffer.data(), buffer.size(), 0);
      if (count <= 0) return;
      request.append(buffer.data(), static_cast<std::size_t>(count));
    }
    const std::size_t begin = request.find(' ') + 1;
    const auto found = answers_.find(request.substr(begin, request.find(' ', begin) - begin));
    const Answer missing = {"404 Not Found", "text/plain", "not here"};
    Answer answer = found == answers_.end() ? missing : found->second;
    const std::string count = "{count}";
    const std::size_t at = answer.body.find(count);
    if (at != std::string::npos) {
      answer.body.replace(at, count.size(), std::to_string(++count_));
    }
    const std::string text = "HTTP/1.1 " + answer.status + "\r\nContent-Type: " + answer.type +
                             "\r\nContent-Length: " + std::to_string(answer.body.size()) +
                             "\r\nConnection: close\r\n\r\n" + answer.body;
    ::send(client, text.data(), text.size(), MSG_NOSIGNAL);
  }

  const std::map<std::string, Answer> answers_;
  const int listener_;
  int count_ = 0;
  std::string url_;
  std::thread thread_;
};

}  // namespace kinescope::testing
