#include "server/mvn/net/udp_datagrams.h"

#include <linux/sock_diag.h>
#include <netinet/in.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <vector>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "server/mvn/datagram.h"
#include "server/mvn/net/allowed_senders.h"

namespace kinescope::mvn {
namespace {

// A burst of 30 frames of four characters is 0.6 MB. The kernel includes its overhead, and the
// buffer should hold a second for a blocked reader.
constexpr int kReceiveBufferBytes = 8 << 20;
constexpr unsigned kBatchSize = 32;
constexpr int kBatchesPerPoll = 16;  // then the caller continues, however fast datagrams arrive

// Reads the kernel's ancillary data of a datagram, by level and type.
template <class Value>
bool ReadControl(const cmsghdr& control, int level, int type, Value& value) {
  if (control.cmsg_level != level || control.cmsg_type != type) return false;
  std::memcpy(&value, CMSG_DATA(&control), sizeof value);
  return true;
}

}  // namespace

// Buffers for recvmmsg; made once, used for every read.
struct UdpDatagrams::Batch {
  static constexpr std::size_t kControlBytes = CMSG_SPACE(sizeof(timespec)) +
                                               CMSG_SPACE(sizeof(in_pktinfo)) +
                                               CMSG_SPACE(sizeof(in6_pktinfo));

  using Bytes = std::array<char, kLargestDatagram>;

  // Apart from the bytes: what every read writes lies together, in a few pages.
  struct Slot {
    alignas(cmsghdr) std::array<char, kControlBytes> control;
    SocketAddress sender;
    iovec vector{};
  };

  std::vector<Bytes> bytes = std::vector<Bytes>(kBatchSize);
  std::vector<Slot> slots = std::vector<Slot>(kBatchSize);
  std::vector<mmsghdr> headers = std::vector<mmsghdr>(kBatchSize);
  ReceivedDatagram datagram;  // the one that is delivered

  // The kernel writes lengths into the headers, so they are reset before each read.
  void Reset() {
    for (std::size_t i = 0; i < slots.size(); ++i) {
      Slot& slot = slots[i];
      slot.vector = {bytes[i].data(), bytes[i].size()};
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

UdpDatagrams::UdpDatagrams(const std::string& url)
    : from_(ParseNetUrl(url).from),
      socket_(BindToListen(ParseNetUrl(url), url)),
      clock_(ReadClocks()),
      batch_(std::make_unique<Batch>()) {
  const SocketAddress bound = LocalAddress(socket_);
  description_ = FormatUrl(Protocol::kUdp, bound);
  local_ = EndpointOf(bound);
  const auto* any = reinterpret_cast<const sockaddr_in*>(&bound.storage);
  if (bound.storage.ss_family == AF_INET && any->sin_addr.s_addr == INADDR_ANY) {
    local_.address = {};  // in place of its IPv4 form
  }
  Configure();
}

UdpDatagrams::~UdpDatagrams() = default;

void UdpDatagrams::Configure() {
  const int wanted = kReceiveBufferBytes;
  // Only root may exceed the system's limit; others get at most net.core.rmem_max.
  if (setsockopt(socket_.get(), SOL_SOCKET, SO_RCVBUFFORCE, &wanted, sizeof wanted) != 0) {
    setsockopt(socket_.get(), SOL_SOCKET, SO_RCVBUF, &wanted, sizeof wanted);
  }
  counters_.receive_buffer_bytes = ReceiveBufferBytes(socket_);
  // Options that may fail: without them receive times include scheduling delays, and a socket that
  // listens on all addresses does not know the destination of a datagram.
  StampArrivals(socket_);
  const int on = 1;
  if (LocalAddress(socket_).storage.ss_family == AF_INET6) {
    setsockopt(socket_.get(), IPPROTO_IPV6, IPV6_RECVPKTINFO, &on, sizeof on);
  } else {
    setsockopt(socket_.get(), IPPROTO_IP, IP_PKTINFO, &on, sizeof on);
  }
}

bool UdpDatagrams::WaitForInput(std::chrono::nanoseconds timeout) {
  const std::int64_t nanos = std::max<std::int64_t>(timeout.count(), 0);
  const timespec wait{static_cast<time_t>(nanos / kNanosPerSecond),
                      static_cast<long>(nanos % kNanosPerSecond)};
  pollfd descriptor{socket_.get(), POLLIN, 0};
  const int ready = ppoll(&descriptor, 1, &wait, nullptr);
  if (ready < 0 && errno != EINTR) {
    throw SourceError(description_ + ": waiting for input failed: " + ErrorText(errno));
  }
  return ready > 0;
}

// Reads the receive time of one datagram from the kernel's stamp, and its destination address.
void UdpDatagrams::ReadAncillary(const void* message_header) {
  msghdr header = *static_cast<const msghdr*>(message_header);
  batch_->datagram.to = local_;
  for (cmsghdr* control = CMSG_FIRSTHDR(&header); control != nullptr;
       control = CMSG_NXTHDR(&header, control)) {
    in_pktinfo ipv4{};
    in6_pktinfo ipv6{};
    if (ReadControl(*control, IPPROTO_IP, IP_PKTINFO, ipv4)) {
      SocketAddress address;
      auto& ip = reinterpret_cast<sockaddr_in&>(address.storage);
      ip.sin_family = AF_INET;
      ip.sin_addr = ipv4.ipi_addr;
      batch_->datagram.to.address = EndpointOf(address).address;
    } else if (ReadControl(*control, IPPROTO_IPV6, IPV6_PKTINFO, ipv6)) {
      std::memcpy(batch_->datagram.to.address.data(), &ipv6.ipi6_addr, sizeof ipv6.ipi6_addr);
    }
  }
  batch_->datagram.arrival = clock_.ArrivalOf(KernelStampOf(header));
}

// Returns the number of datagrams read; 0 if there are none.
int UdpDatagrams::ReadBatch(DatagramSink& sink) {
  batch_->Reset();
  const int count =
      recvmmsg(socket_.get(), batch_->headers.data(), kBatchSize, MSG_DONTWAIT, nullptr);
  if (count < 0) {
    if (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR) return 0;
    throw SourceError(description_ + ": reading failed: " + ErrorText(errno));
  }
  if (const std::int64_t set_by = clock_.Read(ReadClocks()); set_by != 0) {
    ++counters_.clock_steps;
    spdlog::warn("the clock of this machine was set by {:+.3f} s; stamps are on the new clock",
                 Secs(set_by));
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    batch_->datagram.from = EndpointOf(batch_->slots[i].sender);
    if (!MaySend(from_, batch_->datagram.from)) {
      if (counters_.strangers++ == 0) WarnOfStranger(description_, batch_->datagram.from);
      continue;
    }
    ReadAncillary(&batch_->headers[i].msg_hdr);
    batch_->datagram.bytes = std::string_view(batch_->bytes[i].data(), batch_->headers[i].msg_len);
    sink.OnDatagram(batch_->datagram);
  }
  return count;
}

DatagramSource::State UdpDatagrams::Poll(std::chrono::nanoseconds timeout, DatagramSink& sink) {
  if (!WaitForInput(timeout)) return State::kIdle;
  for (int batch = 0; batch < kBatchesPerPoll; ++batch) {
    if (ReadBatch(sink) < static_cast<int>(kBatchSize)) return State::kIdle;
  }
  return State::kMore;
}

// Asked for and not sent with the datagrams: those carry the count only after the loss, so one at
// the end of a flood would never be counted.
TransportCounters UdpDatagrams::counters() const {
  TransportCounters counters = counters_;
  std::array<std::uint32_t, SK_MEMINFO_VARS> memory{};
  socklen_t size = sizeof memory;
  if (getsockopt(socket_.get(), SOL_SOCKET, SO_MEMINFO, memory.data(), &size) == 0) {
    counters.kernel_drops = memory[SK_MEMINFO_DROPS];
  }
  return counters;
}

std::unique_ptr<DatagramSource> OpenUdpDatagrams(const std::string& url) {
  return std::make_unique<UdpDatagrams>(url);
}

}  // namespace kinescope::mvn
