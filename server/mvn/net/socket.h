/// Sockets and their addresses: what UDP and TCP, receivers and senders have in common.
#pragma once

#include <sys/socket.h>

#include <cstdint>
#include <string>
#include <vector>

#include "server/mvn/arrival.h"
#include "server/mvn/endpoint.h"
#include "server/mvn/net/net_url.h"

namespace kinescope::mvn {

/// An open socket, closed at the end.
class Socket {
 public:
  Socket() = default;  // none
  explicit Socket(int descriptor) : descriptor_(descriptor) {}
  ~Socket();
  Socket(Socket&& other) noexcept;
  Socket& operator=(Socket&& other) noexcept;
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  int get() const { return descriptor_; }
  bool is_open() const { return descriptor_ >= 0; }

 private:
  int descriptor_ = -1;
};

/// A socket address and its length.
struct SocketAddress {
  sockaddr_storage storage{};
  socklen_t size = 0;

  const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&storage); }
  sockaddr* get() { return reinterpret_cast<sockaddr*>(&storage); }
};

/// `url.host` as an address of this machine: numbers and "localhost" only. `text` is the URL as the
/// user wrote it, for errors. @throws SourceError.
SocketAddress ResolveToListen(const NetUrl& url, const std::string& text);

/// `url.host` as the addresses that it has, best first, at least one; asks the name service, which
/// may take seconds. @throws SourceError, also when there is no host or no port to send to.
std::vector<SocketAddress> ResolveToSend(const NetUrl& url, const std::string& text);

/// A socket that does not block, bound to `url`; an IPv6 "every address" takes IPv4, too.
/// @throws SourceError naming what holds the port, or which addresses there are.
Socket BindToListen(const NetUrl& url, const std::string& text);

/// Both ends as the socket has them now; all zero where it has none.
SocketAddress LocalAddress(const Socket& socket);
SocketAddress PeerAddress(const Socket& socket);

/// IPv4 is mapped into IPv6.
Endpoint EndpointOf(const SocketAddress& address);

/// "udp://127.0.0.1:9763", "tcp://[fe80::1%eth0]:9763".
std::string FormatUrl(Protocol protocol, const SocketAddress& address);

/// What the kernel really gave, its own book-keeping included.
int ReceiveBufferBytes(const Socket& socket);

/// "Connection refused".
std::string ErrorText(int error);

/// The present instant on both clocks.
Arrival ReadClocks();

}  // namespace kinescope::mvn
