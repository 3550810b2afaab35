#include "server/mvn/net/tcp_connector.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <spdlog/spdlog.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "core/system/clocks.h"

namespace kinescope::mvn {
namespace {

constexpr std::int64_t kBetweenAttempts = kNanosPerSecond;
// A host that is switched off does not answer; the kernel would try for two minutes.
constexpr std::int64_t kLongestAttempt = 5 * kNanosPerSecond;
// The end of a connection that lasted this long is logged.
constexpr std::int64_t kHeld = 10 * kNanosPerSecond;

void Set(const Socket& socket, int level, int option, int value) {
  setsockopt(socket.get(), level, option, &value, sizeof value);
}

// With automatically chosen ports, a socket can connect to itself.
bool IsConnectedToItself(const Socket& socket) {
  return EndpointOf(LocalAddress(socket)) == EndpointOf(PeerAddress(socket));
}

}  // namespace

void ConfigureConnection(const Socket& socket) {
  Set(socket, IPPROTO_TCP, TCP_NODELAY, 1);
  Set(socket, SOL_SOCKET, SO_KEEPALIVE, 1);
  Set(socket, IPPROTO_TCP, TCP_KEEPIDLE, 5);
  Set(socket, IPPROTO_TCP, TCP_KEEPINTVL, 2);
  Set(socket, IPPROTO_TCP, TCP_KEEPCNT, 3);
  // The limit for data under way, which the kernel would otherwise repeat for minutes.
  Set(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, 10'000);
}

TcpConnector::TcpConnector(const NetUrl& url, const std::string& text)
    : text_(text), addresses_(ResolveToSend(url, text)) {}

Socket TcpConnector::Advance(std::int64_t now_monotonic_nanos) {
  if (is_connected_) return Socket();
  if (!attempt_.is_open()) {
    if (has_begun_ && now_monotonic_nanos < deadline_nanos()) return Socket();
    Begin(now_monotonic_nanos);
  }
  if (attempt_.is_open() && Finish()) {
    is_connected_ = true;
    connected_nanos_ = now_monotonic_nanos;
    if (!std::exchange(has_told_connection_, true)) spdlog::info("{}: connected", text_);
    return std::move(attempt_);
  }
  if (attempt_.is_open() && now_monotonic_nanos >= deadline_nanos()) Fail(ETIMEDOUT);
  return Socket();
}

void TcpConnector::Restart(std::int64_t now_monotonic_nanos) {
  is_connected_ = false;
  if (now_monotonic_nanos - connected_nanos_ >= kHeld) {
    has_told_trouble_ = has_told_connection_ = false;
  }
  TellTrouble("connection lost");
}

// Logs the problem once, and not once per second while a suit is switched off.
void TcpConnector::TellTrouble(const std::string& what) {
  if (std::exchange(has_told_trouble_, true)) return;
  spdlog::warn("{}: {}; retrying every second", text_, what);
}

std::int64_t TcpConnector::deadline_nanos() const {
  if (!has_begun_) return 0;
  return began_nanos_ + (attempt_.is_open() ? kLongestAttempt : kBetweenAttempts);
}

void TcpConnector::Begin(std::int64_t now) {
  const SocketAddress& address = addresses_[next_address_];
  next_address_ = (next_address_ + 1) % addresses_.size();
  began_nanos_ = now;
  has_begun_ = true;
  attempt_ =
      Socket(::socket(address.storage.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!attempt_.is_open()) return Fail(errno);
  ConfigureConnection(attempt_);
  if (connect(attempt_.get(), address.get(), address.size) != 0 && errno != EINPROGRESS) {
    Fail(errno);
  }
}

// Whether the attempt has succeeded.
bool TcpConnector::Finish() {
  pollfd descriptor{attempt_.get(), POLLOUT, 0};
  if (poll(&descriptor, 1, 0) <= 0) return false;
  int error = 0;
  socklen_t size = sizeof error;
  getsockopt(attempt_.get(), SOL_SOCKET, SO_ERROR, &error, &size);
  if (error == 0 && IsConnectedToItself(attempt_)) error = ECONNREFUSED;
  if (error == 0) return true;
  Fail(error);
  return false;
}

void TcpConnector::Fail(int error) {
  TellTrouble("cannot connect yet (" + ErrorText(error) + ")");
  attempt_ = Socket();
}

}  // namespace kinescope::mvn
