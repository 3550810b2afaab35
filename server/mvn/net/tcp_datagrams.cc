#include "server/mvn/net/tcp_datagrams.h"

#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "server/mvn/datagram.h"
#include "server/mvn/giving_way.h"
#include "server/mvn/net/allowed_senders.h"
#include "server/mvn/net/arrival_clock.h"
#include "server/mvn/stream_framer.h"

namespace kinescope::mvn {
namespace {

constexpr std::size_t kReadBytes = 65536;

// Errors of accept() that do not affect the next connection.
bool IsPassing(int error) {
  return error == EINTR || error == ECONNABORTED || error == EPROTO || error == ENETDOWN ||
         error == ENETUNREACH || error == EHOSTUNREACH || error == EPERM;
}

}  // namespace

struct TcpDatagrams::Connection {
  Socket socket;
  ReceivedDatagram datagram;  // the one that is delivered; both ends are the same for all
  StreamFramer framer;
  ArrivalClock clock{ReadClocks()};
  bool has_ended = false;
  // Receive times, monotonic clock; 0: never.
  std::int64_t opened_nanos = 0, datagram_nanos = 0, body_nanos = 0;

  void HandOn(DatagramSink& sink) {
    while (const auto bytes = framer.Next()) {
      datagram.bytes = *bytes;
      datagram_nanos = datagram.arrival.monotonic_nanos;
      NoticeBody();
      sink.OnDatagram(datagram);
    }
  }

  // Looked for a few times a second, so that it costs nothing.
  void NoticeBody() {
    constexpr std::int64_t kLookAgain = 200 * kNanosPerMilli;
    if (datagram_nanos - body_nanos < kLookAgain) return;
    const auto message = ParseDatagram(datagram.bytes);
    if (message && HasWholeBody(*message)) body_nanos = datagram_nanos;
  }

  bool IsIdle(std::int64_t now, const Patience& patience) const {
    return datagram_nanos == 0 ? now - opened_nanos > patience.first_datagram
                               : now - datagram_nanos > patience.next_datagram;
  }
};

TcpDatagrams::TcpDatagrams(const std::string& url, const Patience& patience)
    : patience_(patience), description_(url), buffer_(kReadBytes, '\0') {
  const NetUrl parsed = ParseNetUrl(url);
  connections_.reserve(kMaxConnections);
  descriptors_.reserve(kMaxConnections + 1);
  if (parsed.mode == NetUrl::Mode::kConnect) {
    port_ = parsed.port;
    connector_.emplace(parsed, url);
    return;
  }
  from_ = parsed.from;
  listener_ = BindToListen(parsed, url);
  StampArrivals(listener_);  // and what its connections receive
  const SocketAddress bound = LocalAddress(listener_);
  description_ = FormatUrl(Protocol::kTcp, bound);
  port_ = EndpointOf(bound).port;
  counters_.receive_buffer_bytes = ReceiveBufferBytes(listener_);
}

TcpDatagrams::~TcpDatagrams() = default;

void TcpDatagrams::CollectDescriptors(std::int64_t now) {
  descriptors_.clear();
  for (const auto& connection : connections_) {
    descriptors_.push_back({connection->socket.get(), POLLIN, 0});
  }
  if (connector_) {
    // poll() skips a descriptor of -1.
    descriptors_.push_back({connector_->descriptor(), POLLOUT, 0});
  } else {
    descriptors_.push_back({now >= accept_again_nanos_ ? listener_.get() : -1, POLLIN, 0});
  }
}

// Time until which to wait (monotonic clock, ns).
std::int64_t TcpDatagrams::Deadline(std::int64_t now, std::chrono::nanoseconds timeout) const {
  constexpr std::int64_t kLongestWait = 1'000'000 * kNanosPerSecond;
  std::int64_t deadline = now + std::clamp<std::int64_t>(timeout.count(), 0, kLongestWait);
  if (connector_ && connections_.empty())
    deadline = std::min(deadline, connector_->deadline_nanos());
  if (accept_again_nanos_ > now) deadline = std::min(deadline, accept_again_nanos_);
  return deadline;
}

// Sets the events of the descriptors.
bool TcpDatagrams::WaitForInput(std::chrono::nanoseconds timeout) {
  const std::int64_t now = ReadClocks().monotonic_nanos;
  CollectDescriptors(now);
  const std::int64_t nanos = std::max<std::int64_t>(Deadline(now, timeout) - now, 0);
  const timespec wait{static_cast<time_t>(nanos / kNanosPerSecond),
                      static_cast<long>(nanos % kNanosPerSecond)};
  const int ready = ppoll(descriptors_.data(), descriptors_.size(), &wait, nullptr);
  if (ready < 0 && errno != EINTR) {
    throw SourceError(description_ + ": waiting for input failed: " + ErrorText(errno));
  }
  return ready > 0;
}

DatagramSource::State TcpDatagrams::Poll(std::chrono::nanoseconds timeout, DatagramSink& sink) {
  bool may_have_more = false;
  if (WaitForInput(timeout)) {
    for (std::size_t i = 0; i < connections_.size(); ++i) {
      if (descriptors_[i].revents != 0) may_have_more |= Read(*connections_[i], sink);
    }
  }
  const std::int64_t now = ReadClocks().monotonic_nanos;
  if (!connector_) EndIdle(now);
  RemoveEnded(now);
  if (connector_) {
    Socket made = connector_->Advance(now);
    if (made.is_open()) Add(std::move(made), now);
  } else if (descriptors_.back().revents != 0) {
    AcceptAll(now);
  }
  return may_have_more ? State::kMore : State::kIdle;
}

void TcpDatagrams::AcceptAll(std::int64_t now) {
  for (std::size_t i = 0; i < kMaxConnections; ++i) {
    Socket newcomer(accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (newcomer.is_open()) {
      ConfigureConnection(newcomer);
      Add(std::move(newcomer), now);
      continue;
    }
    if (errno == EAGAIN || errno == EWOULDBLOCK) return;
    if (IsPassing(errno)) continue;
    // Out of descriptors or memory: the connection stays in the queue and would wake this thread
    // without end.
    if (accept_again_nanos_ == 0) {
      spdlog::warn("{}: cannot accept a connection ({}); retrying every second", description_,
                   ErrorText(errno));
    }
    accept_again_nanos_ = now + kNanosPerSecond;
    return;
  }
}

// Ends the connection that gives way, if there is one.
bool TcpDatagrams::MakeRoom(const Endpoint& newcomer, std::int64_t now) {
  if (connections_.size() < kMaxConnections) return true;
  std::vector<PlaceHolder> holders;
  for (const auto& connection : connections_) {
    const bool has_body =
        connection->body_nanos != 0 && now - connection->body_nanos < patience_.next_body;
    holders.push_back({connection->datagram.from, has_body, connection->datagram_nanos != 0,
                       connection->opened_nanos});
  }
  // The address of a connection is certain, so what it will send need not be known.
  const auto index = WhoGivesWay(holders, newcomer, true);
  if (!index) return false;
  const auto victim = connections_.begin() + static_cast<std::ptrdiff_t>(*index);
  Remember(**victim);
  ++counters_.connections_ended;
  connections_.erase(victim);
  return true;
}

void TcpDatagrams::Add(Socket socket, std::int64_t now) {
  const Endpoint sender = EndpointOf(PeerAddress(socket));
  if (!MaySend(from_, sender)) {
    if (counters_.strangers++ == 0) WarnOfStranger(description_, sender);
    return;
  }
  if (!MakeRoom(sender, now)) {
    if (counters_.connections_refused++ == 0) {
      spdlog::warn("{}: more than {} connections; {} and all further ones are rejected",
                   description_, kMaxConnections, Format(sender));
    }
    return;
  }
  auto connection = std::make_unique<Connection>();
  connection->opened_nanos = now;
  connection->datagram.from = sender;
  connection->datagram.to = EndpointOf(LocalAddress(socket));
  counters_.receive_buffer_bytes = ReceiveBufferBytes(socket);
  ++counters_.connections;
  StampArrivals(socket);
  connection->socket = std::move(socket);
  connections_.push_back(std::move(connection));
}

// Reads once: bytes that arrived together have the receive time of the last of them. Returns
// whether there may be more to read.
bool TcpDatagrams::Read(Connection& connection, DatagramSink& sink) {
  iovec vector{buffer_.data(), buffer_.size()};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(timespec))> control{};
  msghdr message{};
  message.msg_iov = &vector;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t size = recvmsg(connection.socket.get(), &message, MSG_DONTWAIT);
  if (size < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR)) return false;
  const Arrival now = ReadClocks();
  connection.clock.Read(now);
  if (clock_.Read(now) != 0) ++counters_.clock_steps;
  connection.datagram.arrival = connection.clock.ArrivalOf(KernelStampOf(message));
  if (size > 0) {
    connection.framer.Append(std::string_view(buffer_).substr(0, static_cast<std::size_t>(size)));
  } else {
    connection.framer.End();
    connection.has_ended = true;
  }
  connection.HandOn(sink);
  return size == static_cast<ssize_t>(buffer_.size());
}

void TcpDatagrams::EndIdle(std::int64_t now) {
  const auto is_idle = [&](const auto& connection) {
    if (connection->has_ended || !connection->IsIdle(now, patience_)) return false;
    Remember(*connection);
    ++counters_.connections_ended;
    return true;
  };
  connections_.erase(std::remove_if(connections_.begin(), connections_.end(), is_idle),
                     connections_.end());
}

// Counters outlive their connection.
void TcpDatagrams::Remember(const Connection& connection) {
  counters_.resyncs += connection.framer.resyncs();
  counters_.skipped_bytes += connection.framer.skipped_bytes();
}

void TcpDatagrams::RemoveEnded(std::int64_t now) {
  const auto has_ended = [](const auto& connection) { return connection->has_ended; };
  for (const auto& connection : connections_) {
    if (!connection->has_ended) continue;
    Remember(*connection);
    ++counters_.connections_lost;
    if (connector_) connector_->Restart(now);
  }
  connections_.erase(std::remove_if(connections_.begin(), connections_.end(), has_ended),
                     connections_.end());
}

TransportCounters TcpDatagrams::counters() const {
  TransportCounters counters = counters_;
  counters.connections_open = static_cast<int>(connections_.size());
  for (const auto& connection : connections_) {
    counters.resyncs += connection->framer.resyncs();
    counters.skipped_bytes += connection->framer.skipped_bytes();
  }
  return counters;
}

std::unique_ptr<DatagramSource> OpenTcpDatagrams(const std::string& url) {
  return std::make_unique<TcpDatagrams>(url);
}

}  // namespace kinescope::mvn
