/// Socket and address functions shared by UDP and TCP, receivers and senders. Any thread; a socket
/// belongs to one thread at a time.
#pragma once

#include <sys/socket.h>

#include <cstdint>
#include <string>
#include <vector>

#include "server/mvn/arrival.h"
#include "server/mvn/endpoint.h"
#include "server/mvn/net/net_url.h"

namespace kinescope::mvn {

/// An open socket, closed by the destructor.
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

/// `url.host` as an address of this machine; only numeric addresses and "localhost". `text`: the
/// URL as the user typed it, for errors. @throws SourceError.
SocketAddress ResolveToListen(const NetUrl& url, const std::string& text);

/// The addresses of `url.host`, best first, at least one. Queries the name service, which may take
/// seconds. @throws SourceError, also if host or port is missing.
std::vector<SocketAddress> ResolveToSend(const NetUrl& url, const std::string& text);

/// A non-blocking socket bound to `url`; the IPv6 address that means "every" accepts IPv4, too.
/// @throws SourceError with the program that uses the port, or the addresses that exist.
Socket BindToListen(const NetUrl& url, const std::string& text);

/// Local and remote address of the socket; all zero if it has none.
SocketAddress LocalAddress(const Socket& socket);
SocketAddress PeerAddress(const Socket& socket);

/// Whether only this machine has it ("127.0.0.1", "::1"), and whether it means every address of
/// this machine.
bool IsLoopback(const SocketAddress& address);
bool IsUnspecified(const SocketAddress& address);

/// IPv4 is mapped into IPv6.
Endpoint EndpointOf(const SocketAddress& address);

/// "udp://127.0.0.1:9763", "tcp://[fe80::1%eth0]:9763".
std::string FormatUrl(Protocol protocol, const SocketAddress& address);

/// The size that the kernel granted, including its own overhead.
int ReceiveBufferBytes(const Socket& socket);

/// "Connection refused".
std::string ErrorText(int error);

/// The current time on both clocks.
Arrival ReadClocks();

}  // namespace kinescope::mvn
