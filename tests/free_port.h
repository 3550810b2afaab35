/// Reserves a TCP port of the loopback interface for programs that cannot choose a free one
/// themselves, such as rosmaster.
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>

namespace kinescope::testing {

/// Reserves the port while this object exists: bound with SO_REUSEADDR and never listened on. A
/// program that sets the same option and requests this port gets it, also again after it has ended.
/// A program that requests any free port does not get it, nor does an outgoing connection. So no
/// other program can take the port while a master is killed and restarted.
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
