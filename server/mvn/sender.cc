#include "server/mvn/sender.h"

#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <vector>

#include "server/core/errors.h"
#include "server/mvn/encode.h"
#include "server/mvn/udp_url.h"

namespace kinescope::mvn {
namespace {

class UdpSender : public Sender {
 public:
  explicit UdpSender(const std::string& url)
      : url_(url),
        to_(ResolveToSend(ParseUdpUrl(url), url)),
        socket_(::socket(to_.storage.ss_family, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    if (socket_.get() < 0) {
      throw SourceError(url + ": cannot open a UDP socket: " + std::strerror(errno));
    }
  }

  void SendCharacter(const Character& character) override { Send(EncodeCharacter(character)); }
  void SendSample(const BodySample& sample) override { Send(EncodeSample(sample)); }
  std::uint64_t datagrams_sent() const override { return datagrams_sent_; }

 private:
  void Send(const std::vector<std::string>& datagrams) {
    for (const std::string& datagram : datagrams) {
      const ssize_t sent =
          sendto(socket_.get(), datagram.data(), datagram.size(), 0, to_.get(), to_.size);
      if (sent >= 0) {
        ++datagrams_sent_;
      } else if (!IsPassing(errno)) {
        throw SourceError(url_ + ": sending failed: " + std::strerror(errno));
      }
    }
  }

  // A suit goes on sending whether or not anybody listens or a cable is out for a moment.
  static bool IsPassing(int error) {
    return error == ECONNREFUSED || error == ENOBUFS || error == EAGAIN || error == EINTR ||
           error == ENETUNREACH || error == EHOSTUNREACH || error == ENETDOWN || error == EPERM;
  }

  std::string url_;
  SocketAddress to_;
  Socket socket_;
  std::uint64_t datagrams_sent_ = 0;
};

}  // namespace

std::unique_ptr<Sender> OpenUdpSender(const std::string& url) {
  return std::make_unique<UdpSender>(url);
}

}  // namespace kinescope::mvn
