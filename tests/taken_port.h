/// A port of the loopback interface that another program uses.
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>
#include <string>

namespace kinescope::testing {

/// Uses any free port while this object exists: no other program can bind it.
class TakenPort {
 public:
  /// `type`: SOCK_STREAM or SOCK_DGRAM.
  explicit TakenPort(int type) : fd_(::socket(AF_INET, type | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    auto* generic = reinterpret_cast<sockaddr*>(&address);
    const bool is_taken = fd_ >= 0 && ::bind(fd_, generic, size) == 0 &&
                          (type != SOCK_STREAM || ::listen(fd_, 1) == 0) &&
                          ::getsockname(fd_, generic, &size) == 0;
    if (!is_taken) throw std::runtime_error("no free port on the loopback");
    number_ = ntohs(address.sin_port);
  }
  ~TakenPort() { ::close(fd_); }
  TakenPort(const TakenPort&) = delete;
  TakenPort& operator=(const TakenPort&) = delete;

  std::string number() const { return std::to_string(number_); }

 private:
  const int fd_;
  int number_ = 0;
};

}  // namespace kinescope::testing
