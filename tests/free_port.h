/// A TCP port of the loopback for programs that cannot take "any" and tell, such as rosmaster.
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>

namespace kinescope::testing {

/// Keeps the port for whoever names it, while it lives: bound and never listened on, with
/// SO_REUSEADDR. A program that sets the same option and asks for this very port gets it, also
/// again after its end; nobody who takes any free port does, nor does a connection that goes out.
/// So a master can be killed and restarted without anybody coming in between.
class FreePort {
 public:
  FreePort() : fd_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const int yes = 1;
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    auto* generic = reinterpret_cast<sockaddr*>(&address);
    const bool is_bound =
        fd_ >= 0 && ::setsockopt(fd_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes)) == 0 &&
        ::bind(fd_, generic, size) == 0 && ::getsockname(fd_, generic, &size) == 0;
    if (!is_bound) throw std::runtime_error("no free port on the loopback");
    number_ = ntohs(address.sin_port);
  }
  ~FreePort() { ::close(fd_); }
  FreePort(const FreePort&) = delete;
  FreePort& operator=(const FreePort&) = delete;

  int number() const { return number_; }

 private:
  const int fd_;
  int number_ = 0;
};

}  // namespace kinescope::testing
