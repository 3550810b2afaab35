#include "server/mvn/udp_source.h"

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <vector>

#include "server/core/errors.h"
#include "server/mvn/open.h"

namespace kinescope::mvn {
namespace {

// A burst of 30 frames of four characters is 0.6 MB; the kernel counts its overhead in, and a
// stalled reader should survive a second of it.
constexpr int kReceiveBufferBytes = 8 << 20;
constexpr unsigned kBatchSize = 32;
constexpr int kBatchesPerPoll = 16;  // then the caller gets its turn, however fast input comes
constexpr std::int64_t kNanosPerSecond = 1'000'000'000;
constexpr std::int64_t kNanosPerMilli = 1'000'000;
constexpr const char* kDroppedByKernel = "dropped by the kernel (receive buffer full)";

std::int64_t ToNanos(const timespec& time) {
  return static_cast<std::int64_t>(time.tv_sec) * kNanosPerSecond + time.tv_nsec;
}

std::int64_t Read(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return ToNanos(time);
}

Arrival Now() { return {Read(CLOCK_MONOTONIC), Read(CLOCK_REALTIME)}; }

[[noreturn]] void RefuseToBind(const std::string& url, std::uint16_t port, int error) {
  const std::string number = std::to_string(port);
  switch (error) {
    case EADDRINUSE:
      throw SourceError(url + ": port " + number + " is taken; `ss -ulpn sport = :" + number +
                        "` shows by which program. Stop that one, or choose another port here and "
                        "in MVN's Network Streamer");
    case EADDRNOTAVAIL:
      throw SourceError(url +
                        ": not an address of this machine; `ip -brief address` lists those, "
                        "and udp://:" +
                        number + " listens on all of them");
    case EACCES:
      throw SourceError(url + ": ports below 1024 need root; choose a higher one, such as 9763");
    default: throw SourceError(url + ": cannot listen: " + std::strerror(error));
  }
}

Endpoint EndpointOf(const SocketAddress& address) {
  Endpoint endpoint;
  if (address.storage.ss_family == AF_INET6) {
    const auto& ip = reinterpret_cast<const sockaddr_in6&>(address.storage);
    std::memcpy(endpoint.address.data(), &ip.sin6_addr, endpoint.address.size());
    endpoint.port = ip.sin6_port;
  } else {
    const auto& ip = reinterpret_cast<const sockaddr_in&>(address.storage);
    endpoint.address[10] = endpoint.address[11] = 0xFF;
    std::memcpy(endpoint.address.data() + 12, &ip.sin_addr, sizeof ip.sin_addr);
    endpoint.port = ip.sin_port;
  }
  return endpoint;
}

}  // namespace

// Where recvmmsg writes; made once, used for every read.
struct UdpSource::Batch {
  static constexpr std::size_t kControlBytes =
      CMSG_SPACE(sizeof(timespec)) + CMSG_SPACE(sizeof(std::uint32_t));

  struct Slot {
    std::array<char, kLargestDatagram> bytes;
    alignas(cmsghdr) std::array<char, kControlBytes> control;
    SocketAddress sender;
    iovec vector{};
  };

  std::vector<Slot> slots = std::vector<Slot>(kBatchSize);
  std::vector<mmsghdr> headers = std::vector<mmsghdr>(kBatchSize);

  // The kernel writes lengths into the headers, so each read needs them fresh.
  void Reset() {
    for (std::size_t i = 0; i < slots.size(); ++i) {
      Slot& slot = slots[i];
      slot.vector = {slot.bytes.data(), slot.bytes.size()};
      msghdr& header = headers[i].msg_hdr;
      header = {};
      header.msg_name = slot.sender.get();
      header.msg_namelen = sizeof slot.sender.storage;
      header.msg_iov = &slot.vector;
      header.msg_iovlen = 1;
      header.msg_control = slot.control.data();
      header.msg_controllen = slot.control.size();
    }
  }
};

UdpSource::UdpSource(const std::string& url)
    : socket_([&url] {
        const int family = ResolveToListen(ParseUdpUrl(url), url).storage.ss_family;
        return ::socket(family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
      }()),
      batch_(std::make_unique<Batch>()) {
  if (socket_.get() < 0) {
    throw SourceError(url + ": cannot open a UDP socket: " + std::strerror(errno));
  }
  Configure();
  Bind(ParseUdpUrl(url), url);
}

UdpSource::~UdpSource() = default;

void UdpSource::Configure() {
  const int wanted = kReceiveBufferBytes;
  // Beyond the system's limit only root may go; others get as much as net.core.rmem_max lets them.
  if (setsockopt(socket_.get(), SOL_SOCKET, SO_RCVBUFFORCE, &wanted, sizeof wanted) != 0) {
    setsockopt(socket_.get(), SOL_SOCKET, SO_RCVBUF, &wanted, sizeof wanted);
  }
  socklen_t size = sizeof receive_buffer_bytes_;
  getsockopt(socket_.get(), SOL_SOCKET, SO_RCVBUF, &receive_buffer_bytes_, &size);
  const int on = 1;
  // Both are refinements: without them drops are not counted, and stamps feel the scheduler.
  setsockopt(socket_.get(), SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on);
  setsockopt(socket_.get(), SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
}

void UdpSource::Bind(const UdpUrl& url, const std::string& text) {
  // No SO_REUSEADDR: with it two programs would share the port and each would miss datagrams.
  const SocketAddress address = ResolveToListen(url, text);
  if (bind(socket_.get(), address.get(), address.size) != 0) RefuseToBind(text, url.port, errno);
  SocketAddress bound;
  bound.size = sizeof bound.storage;
  getsockname(socket_.get(), bound.get(), &bound.size);
  description_ = FormatUdpUrl(bound);
  port_ = ntohs(EndpointOf(bound).port);
}

bool UdpSource::WaitForInput(std::chrono::milliseconds timeout) {
  std::int64_t wait_millis = std::max<std::int64_t>(timeout.count(), 0);
  if (const auto deadline = assembler_.deadline_nanos()) {
    const std::int64_t left = *deadline - Read(CLOCK_MONOTONIC);
    // Rounded up: a millisecond late beats waking in vain until it is due.
    wait_millis = std::min(wait_millis,
                           std::max<std::int64_t>((left + kNanosPerMilli - 1) / kNanosPerMilli, 0));
  }
  pollfd descriptor{socket_.get(), POLLIN, 0};
  constexpr std::int64_t kLongestWait = 1'000'000'000;  // poll takes an int
  const int ready = poll(&descriptor, 1, static_cast<int>(std::min(wait_millis, kLongestWait)));
  if (ready < 0 && errno != EINTR) {
    throw SourceError(description_ + ": waiting for input failed: " + std::strerror(errno));
  }
  return ready > 0;
}

// Arrival of one datagram by the kernel's own stamp, and what the kernel says about lost ones.
Arrival UdpSource::Inspect(const void* message_header, const Arrival& now) {
  msghdr header = *static_cast<const msghdr*>(message_header);
  Arrival arrival = now;
  for (cmsghdr* control = CMSG_FIRSTHDR(&header); control != nullptr;
       control = CMSG_NXTHDR(&header, control)) {
    if (control->cmsg_level != SOL_SOCKET) continue;
    if (control->cmsg_type == SO_TIMESTAMPNS) {
      timespec stamp{};
      std::memcpy(&stamp, CMSG_DATA(control), sizeof stamp);
      // The wall clock may have been set in between: then the kernel's stamp is of no use.
      const std::int64_t queued = now.wall_nanos - ToNanos(stamp);
      if (queued >= 0 && queued < kNanosPerSecond) {
        arrival = {now.monotonic_nanos - queued, now.wall_nanos - queued};
      }
    } else if (control->cmsg_type == SO_RXQ_OVFL) {
      std::uint32_t overflow = 0;
      std::memcpy(&overflow, CMSG_DATA(control), sizeof overflow);
      kernel_drops_ += overflow - last_overflow_;
      last_overflow_ = overflow;
    }
  }
  return arrival;
}

// Number of datagrams read; 0 when there are none.
int UdpSource::ReadBatch(SampleSink& sink) {
  batch_->Reset();
  const int count =
      recvmmsg(socket_.get(), batch_->headers.data(), kBatchSize, MSG_DONTWAIT, nullptr);
  if (count < 0) {
    if (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR) return 0;
    throw SourceError(description_ + ": reading failed: " + std::strerror(errno));
  }
  const Arrival now = Now();
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const Arrival arrival = Inspect(&batch_->headers[i].msg_hdr, now);
    const std::string_view datagram(batch_->slots[i].bytes.data(), batch_->headers[i].msg_len);
    assembler_.Add(EndpointOf(batch_->slots[i].sender), datagram, arrival, sink);
  }
  return count;
}

Source::State UdpSource::Poll(std::chrono::milliseconds timeout, SampleSink& sink) {
  bool read_all = true;
  if (WaitForInput(timeout)) {
    for (int batch = 0; batch < kBatchesPerPoll; ++batch) {
      read_all = ReadBatch(sink) < static_cast<int>(kBatchSize);
      if (read_all) break;
    }
  }
  // The rest of an overdue sample may still lie in the socket.
  if (read_all) assembler_.Expire(Read(CLOCK_MONOTONIC), sink);
  return State::kMore;
}

SourceCounters UdpSource::counters() const {
  SourceCounters counters = assembler_.counters();
  if (kernel_drops_ > 0) counters.rejected[kDroppedByKernel] = kernel_drops_;
  return counters;
}

std::unique_ptr<Source> OpenUdp(const std::string& url) { return std::make_unique<UdpSource>(url); }

}  // namespace kinescope::mvn
