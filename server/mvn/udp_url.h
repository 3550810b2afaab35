/// `udp://host:port` for receiver and sender.
#pragma once

#include <sys/socket.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace kinescope::mvn {

inline constexpr std::uint16_t kDefaultPort = 9763;  // MVN's own

struct UdpUrl {
  std::string host;  // "" for all addresses of this machine; no brackets
  std::uint16_t port = kDefaultPort;
};

/// `udp://:9763`, `udp://127.0.0.1:9763`, `udp://[::1]:9763`, `udp://localhost` (port 9763); port 0
/// takes a free one when listening. Pure.
/// @throws SourceError naming the URL, what is wrong with it and what would be right.
UdpUrl ParseUdpUrl(std::string_view url);

/// A socket address and its length.
struct SocketAddress {
  sockaddr_storage storage{};
  socklen_t size = 0;

  const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&storage); }
  sockaddr* get() { return reinterpret_cast<sockaddr*>(&storage); }
};

/// `url.host` as an address. Listening takes numbers and "localhost" only, and "" means every IPv4
/// address; sending asks the name service too. `text` is the URL as the user wrote it, for errors.
/// @throws SourceError.
SocketAddress ResolveToListen(const UdpUrl& url, const std::string& text);
SocketAddress ResolveToSend(const UdpUrl& url, const std::string& text);

/// "udp://127.0.0.1:9763", "udp://[::1]:9763".
std::string FormatUdpUrl(const SocketAddress& address);

/// An open socket, closed at the end.
class Socket {
 public:
  explicit Socket(int descriptor) : descriptor_(descriptor) {}
  ~Socket();
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  int get() const { return descriptor_; }

 private:
  int descriptor_;
};

}  // namespace kinescope::mvn
