#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "server/mvn/datagram_extent.h"
#include "server/mvn/net/socket.h"
#include "server/mvn/net/tcp_connector.h"
#include "server/mvn/net/transport_senders.h"

namespace kinescope::mvn {
namespace {

constexpr std::size_t kMaxReceivers = 16;
// One second of one person with all messages. A longer queue would only make the received data
// older.
constexpr std::size_t kQueueBytes = 1 << 20;
constexpr int kSendBufferBytes = 256 << 10;
// Time limit for the first connection, and for the last bytes.
constexpr std::int64_t kPatience = 1000 * kNanosPerMilli;

std::int64_t Now() { return ReadClocks().monotonic_nanos; }

// Waits for an event of `descriptor`, or until `deadline`.
void WaitFor(int descriptor, std::int64_t deadline) {
  pollfd waiting{descriptor, POLLOUT, 0};
  const std::int64_t millis = (deadline - Now() + kNanosPerMilli - 1) / kNanosPerMilli;
  if (millis > 0) poll(&waiting, 1, static_cast<int>(millis));
}

// One connection and the data that it could not send yet: complete datagrams, and the rest of one.
class Receiver {
 public:
  explicit Receiver(Socket socket) : socket_(std::move(socket)) {
    setsockopt(socket_.get(), SOL_SOCKET, SO_SNDBUF, &kSendBufferBytes, sizeof kSendBufferBytes);
    queue_.reserve(kQueueBytes + kLargestExtent);
  }

  int descriptor() const { return socket_.get(); }
  bool is_gone() const { return is_gone_; }
  bool has_queue() const { return written_ < queue_.size(); }

  /// Sends as much of the queue as possible.
  void Flush() {
    if (has_queue()) written_ += Write(std::string_view(queue_).substr(written_));
    if (has_queue()) return;
    queue_.clear();
    written_ = 0;
  }

  /// Returns false, and sends nothing of `datagram`, if there is no room.
  bool Take(std::string_view datagram) {
    Flush();
    if (!has_queue()) datagram.remove_prefix(Write(datagram));
    if (is_gone_) return false;
    if (datagram.empty()) return true;
    if (queue_.size() - written_ + datagram.size() > kQueueBytes && has_queue()) return false;
    if (queue_.size() + datagram.size() > queue_.capacity()) {
      queue_.erase(0, written_);
      written_ = 0;
    }
    queue_.append(datagram);
    return true;
  }

  void Drop() { is_gone_ = true; }

 private:
  // The number of `bytes` that the kernel accepted.
  std::size_t Write(std::string_view bytes) {
    if (is_gone_) return 0;
    const ssize_t sent =
        send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent >= 0) return static_cast<std::size_t>(sent);
    is_gone_ = errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR && errno != ENOBUFS;
    return 0;
  }

  Socket socket_;
  std::string queue_;
  std::size_t written_ = 0;  // of the queue
  bool is_gone_ = false;
};

class TcpSender : public DatagramSender {
 public:
  TcpSender(const NetUrl& url, const std::string& text) : description_(text) {
    if (url.mode == NetUrl::Mode::kListen) {
      listener_ = BindToListen(url, text);
      description_ = FormatUrl(Protocol::kTcp, LocalAddress(listener_));
      return;
    }
    connector_.emplace(url, text);
    // So that an existing receiver also gets the first datagrams.
    const std::int64_t deadline = Now() + kPatience;
    do {
      Progress();
      if (!receivers_.empty() || connector_->descriptor() < 0) break;
      WaitFor(connector_->descriptor(), deadline);
    } while (Now() < deadline);
  }

  ~TcpSender() override {
    const std::int64_t deadline = Now() + kPatience;
    for (const auto& receiver : receivers_) {
      receiver->Flush();
      while (receiver->has_queue() && !receiver->is_gone() && Now() < deadline) {
        WaitFor(receiver->descriptor(), deadline);
        receiver->Flush();
      }
    }
  }

  void Send(std::string_view datagram) override {
    if (datagram.size() > kLargestExtent) {
      throw SourceError(description_ + ": " + std::to_string(datagram.size()) +
                        " bytes are too long for a datagram; the limit is " +
                        std::to_string(kLargestExtent));
    }
    Progress();
    bool is_sent = !receivers_.empty();
    for (const auto& receiver : receivers_) is_sent &= receiver->Take(datagram);
    ++(is_sent ? sent_ : unsent_);
  }

  std::uint64_t datagrams_sent() const override { return sent_; }
  std::uint64_t datagrams_unsent() const override { return unsent_; }
  std::string description() const override { return description_; }

 private:
  // Accepts and removes receivers; never waits.
  void Progress() {
    DropGone();
    if (connector_) {
      Socket made = connector_->Advance(Now());
      if (made.is_open()) Add(std::move(made));
      return;
    }
    while (true) {
      Socket newcomer(accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
      if (!newcomer.is_open()) return;  // none, or one that is accepted with the next call
      ConfigureConnection(newcomer);
      Add(std::move(newcomer));
    }
  }

  void DropGone() {
    descriptors_.clear();
    for (const auto& receiver : receivers_) descriptors_.push_back({receiver->descriptor(), 0, 0});
    if (descriptors_.empty()) return;
    poll(descriptors_.data(), descriptors_.size(), 0);
    for (std::size_t i = 0; i < receivers_.size(); ++i) {
      if ((descriptors_[i].revents & (POLLERR | POLLHUP)) != 0) receivers_[i]->Drop();
    }
    const auto end = std::remove_if(receivers_.begin(), receivers_.end(),
                                    [](const auto& receiver) { return receiver->is_gone(); });
    if (end == receivers_.end()) return;
    receivers_.erase(end, receivers_.end());
    if (connector_) connector_->Restart(Now());
  }

  void Add(Socket socket) {
    if (receivers_.size() < kMaxReceivers) {
      receivers_.push_back(std::make_unique<Receiver>(std::move(socket)));
    } else if (!std::exchange(has_refused_, true)) {
      spdlog::warn("{}: more than {} receivers; all further ones are rejected", description_,
                   kMaxReceivers);
    }
  }

  std::string description_;
  Socket listener_;                        // when listening
  std::optional<TcpConnector> connector_;  // when connecting
  std::vector<std::unique_ptr<Receiver>> receivers_;
  std::vector<pollfd> descriptors_;
  bool has_refused_ = false;
  std::uint64_t sent_ = 0;
  std::uint64_t unsent_ = 0;
};

}  // namespace

std::unique_ptr<DatagramSender> OpenTcpSender(const NetUrl& url, const std::string& text) {
  return std::make_unique<TcpSender>(url, text);
}

}  // namespace kinescope::mvn
