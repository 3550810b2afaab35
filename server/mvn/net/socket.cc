#include "server/mvn/net/socket.h"

#include <netdb.h>
#include <netinet/in.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <system_error>
#include <utility>

#include "core/system/clocks.h"
#include "core/system/errors.h"

namespace kinescope::mvn {
namespace {

[[noreturn]] void Refuse(const std::string& url, const std::string& why) {
  throw SourceError(url + ": " + why);
}

int SocketType(Protocol protocol) { return protocol == Protocol::kUdp ? SOCK_DGRAM : SOCK_STREAM; }

std::vector<SocketAddress> Resolve(const NetUrl& url, const std::string& text, int flags,
                                   const std::string& way_out) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SocketType(url.protocol);
  hints.ai_flags = flags | AI_NUMERICSERV;
  // The name service would return ::1 first, which a listener on all IPv4 addresses does not
  // receive.
  const std::string host = url.host == "localhost" ? "127.0.0.1" : url.host;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(host.c_str(), std::to_string(url.port).c_str(), &hints, &found);
  if (error != 0) {
    Refuse(text, "cannot resolve '" + url.host + "' (" + gai_strerror(error) + "); " + way_out);
  }
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, &freeaddrinfo);
  std::vector<SocketAddress> addresses;
  for (const addrinfo* each = found; each != nullptr; each = each->ai_next) {
    SocketAddress& address = addresses.emplace_back();
    address.size = each->ai_addrlen;
    std::memcpy(&address.storage, each->ai_addr, each->ai_addrlen);
  }
  return addresses;
}

[[noreturn]] void RefuseToBind(const NetUrl& url, const std::string& text, int error) {
  const std::string port = std::to_string(url.port);
  const std::string scheme = Scheme(url.protocol);
  switch (error) {
    case EADDRINUSE:
      Refuse(text, "port " + port + " is already in use; `ss -" +
                       (url.protocol == Protocol::kUdp ? "u" : "t") + "lpn sport = :" + port +
                       "` lists the program that uses it. Stop that program, or choose another "
                       "port here and in MVN's Network Streamer");
    case EADDRNOTAVAIL:
      Refuse(text, "not an address of this machine; `ip -brief address` lists its addresses, and " +
                       scheme + "://:" + port + " listens on all of them");
    case EACCES: Refuse(text, "ports below 1024 need root; choose a higher one, such as 9763");
    default: Refuse(text, "cannot listen: " + ErrorText(error));
  }
}

}  // namespace

Socket::~Socket() {
  if (descriptor_ >= 0) close(descriptor_);
}

Socket::Socket(Socket&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

Socket& Socket::operator=(Socket&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

SocketAddress ResolveToListen(const NetUrl& url, const std::string& text) {
  NetUrl numeric = url;
  if (numeric.host.empty()) numeric.host = "0.0.0.0";
  return Resolve(numeric, text, AI_NUMERICHOST,
                 "use a numeric address of this machine, or omit it to listen on all of them: " +
                     std::string(Scheme(url.protocol)) + "://:9763")
      .front();
}

std::vector<SocketAddress> ResolveToSend(const NetUrl& url, const std::string& text) {
  if (url.port == 0) Refuse(text, "cannot send to port 0; MVN receivers listen on 9763");
  if (url.host.empty()) {
    Refuse(text, "the host is missing; expected " + std::string(Scheme(url.protocol)) +
                     "://127.0.0.1:9763 or another machine's name");
  }
  return Resolve(url, text, 0, "check the name, or use a numeric address");
}

Socket BindToListen(const NetUrl& url, const std::string& text) {
  const SocketAddress address = ResolveToListen(url, text);
  const int family = address.storage.ss_family;
  Socket socket(::socket(family, SocketType(url.protocol) | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!socket.is_open()) {
    const bool is_missing = errno == EAFNOSUPPORT && family == AF_INET6;
    Refuse(text, "cannot open a socket: " + ErrorText(errno) +
                     (is_missing ? "; this machine does not support IPv6, listen on " +
                                       std::string(Scheme(url.protocol)) + "://:9763"
                                 : ""));
  }
  const int off = 0;
  const int on = 1;
  if (family == AF_INET6) {
    setsockopt(socket.get(), IPPROTO_IPV6, IPV6_V6ONLY, &off, sizeof off);
  }
  // TCP: connections of an earlier run may still linger. UDP: two programs would share the port,
  // and each would miss datagrams.
  if (url.protocol == Protocol::kTcp) {
    setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  }
  if (bind(socket.get(), address.get(), address.size) != 0) RefuseToBind(url, text, errno);
  // A second TCP listener passes bind() and fails here, because of SO_REUSEADDR.
  if (url.protocol == Protocol::kTcp && listen(socket.get(), SOMAXCONN) != 0) {
    RefuseToBind(url, text, errno);
  }
  return socket;
}

SocketAddress LocalAddress(const Socket& socket) {
  SocketAddress address;
  address.size = sizeof address.storage;
  if (getsockname(socket.get(), address.get(), &address.size) != 0) return {};
  return address;
}

SocketAddress PeerAddress(const Socket& socket) {
  SocketAddress address;
  address.size = sizeof address.storage;
  if (getpeername(socket.get(), address.get(), &address.size) != 0) return {};
  return address;
}

bool IsLoopback(const SocketAddress& address) {
  if (address.storage.ss_family == AF_INET6) {
    return IN6_IS_ADDR_LOOPBACK(&reinterpret_cast<const sockaddr_in6&>(address.storage).sin6_addr);
  }
  constexpr std::uint32_t kLoopbackNet = 127;
  const auto& ip = reinterpret_cast<const sockaddr_in&>(address.storage);
  return ntohl(ip.sin_addr.s_addr) >> 24 == kLoopbackNet;
}

bool IsUnspecified(const SocketAddress& address) {
  if (address.storage.ss_family == AF_INET6) {
    return IN6_IS_ADDR_UNSPECIFIED(
        &reinterpret_cast<const sockaddr_in6&>(address.storage).sin6_addr);
  }
  return reinterpret_cast<const sockaddr_in&>(address.storage).sin_addr.s_addr == INADDR_ANY;
}

Endpoint EndpointOf(const SocketAddress& address) {
  Endpoint endpoint;
  if (address.storage.ss_family == AF_INET6) {
    const auto& ip = reinterpret_cast<const sockaddr_in6&>(address.storage);
    std::memcpy(endpoint.address.data(), &ip.sin6_addr, endpoint.address.size());
    endpoint.port = ntohs(ip.sin6_port);
  } else if (address.storage.ss_family == AF_INET) {
    const auto& ip = reinterpret_cast<const sockaddr_in&>(address.storage);
    endpoint.address[10] = endpoint.address[11] = 0xFF;
    std::memcpy(endpoint.address.data() + 12, &ip.sin_addr, sizeof ip.sin_addr);
    endpoint.port = ntohs(ip.sin_port);
  }
  return endpoint;
}

std::string FormatUrl(Protocol protocol, const SocketAddress& address) {
  std::array<char, NI_MAXHOST> host{};
  std::array<char, NI_MAXSERV> port{};
  const std::string scheme = std::string(Scheme(protocol)) + "://";
  const int error = getnameinfo(address.get(), address.size, host.data(), host.size(), port.data(),
                                port.size(), NI_NUMERICHOST | NI_NUMERICSERV);
  if (error != 0) return scheme + "(" + gai_strerror(error) + ")";
  if (address.storage.ss_family == AF_INET6) {
    return scheme + "[" + host.data() + "]:" + port.data();
  }
  return scheme + host.data() + ":" + port.data();
}

int ReceiveBufferBytes(const Socket& socket) {
  int bytes = 0;
  socklen_t size = sizeof bytes;
  getsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &bytes, &size);
  return bytes;
}

std::string ErrorText(int error) { return std::generic_category().message(error); }

Arrival ReadClocks() {
  constexpr std::int64_t kAtOnce = 20'000;
  constexpr int kMaxTries = 4;
  Arrival arrival;
  for (int i = 0; i < kMaxTries; ++i) {
    const std::int64_t before = MonotonicNanos();
    arrival.wall_nanos = WallNanos();
    const std::int64_t took = MonotonicNanos() - before;
    arrival.monotonic_nanos = before + took / 2;
    if (took <= kAtOnce) break;  // otherwise the call was interrupted in between
  }
  return arrival;
}

}  // namespace kinescope::mvn
