#include <sys/socket.h>

#include <cerrno>

#include "core/system/errors.h"
#include "server/mvn/net/socket.h"
#include "server/mvn/net/transport_senders.h"

namespace kinescope::mvn {
namespace {

class UdpSender : public DatagramSender {
 public:
  UdpSender(const NetUrl& url, const std::string& text)
      : text_(text),
        to_(ResolveToSend(url, text).front()),
        socket_(::socket(to_.storage.ss_family, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    if (!socket_.is_open()) {
      throw SourceError(text + ": cannot open a UDP socket: " + ErrorText(errno));
    }
    // A broadcast address is a valid receiver.
    const int on = 1;
    setsockopt(socket_.get(), SOL_SOCKET, SO_BROADCAST, &on, sizeof on);
  }

  void Send(std::string_view datagram) override {
    const ssize_t sent =
        sendto(socket_.get(), datagram.data(), datagram.size(), 0, to_.get(), to_.size);
    if (sent >= 0) {
      ++sent_;
    } else if (IsPassing(errno)) {
      ++unsent_;
    } else {
      throw SourceError(text_ + ": sending " + std::to_string(datagram.size()) +
                        " bytes failed: " + ErrorText(errno) +
                        (errno == EMSGSIZE ? "; the limit of UDP is 65507 bytes" : ""));
    }
  }

  std::uint64_t datagrams_sent() const override { return sent_; }
  std::uint64_t datagrams_unsent() const override { return unsent_; }
  std::string description() const override { return FormatUrl(Protocol::kUdp, to_); }

 private:
  // A suit continues sending without a receiver, and while a cable is unplugged for a moment.
  static bool IsPassing(int error) {
    return error == ECONNREFUSED || error == ENOBUFS || error == EAGAIN || error == EINTR ||
           error == ENETUNREACH || error == EHOSTUNREACH || error == ENETDOWN || error == EPERM;
  }

  std::string text_;
  SocketAddress to_;
  Socket socket_;
  std::uint64_t sent_ = 0;
  std::uint64_t unsent_ = 0;
};

}  // namespace

std::unique_ptr<DatagramSender> OpenUdpSender(const NetUrl& url, const std::string& text) {
  return std::make_unique<UdpSender>(url, text);
}

}  // namespace kinescope::mvn
