/// Address and port of the sender or receiver of a datagram. Plain data and pure functions, any
/// thread.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace kinescope::mvn {

struct Endpoint {
  std::array<std::uint8_t, 16> address{};  // IPv6, or IPv4 mapped into it (::ffff:a.b.c.d)
  std::uint16_t port = 0;                  // host byte order

  bool operator==(const Endpoint& other) const {
    return address == other.address && port == other.port;
  }
  bool operator!=(const Endpoint& other) const { return !(*this == other); }
};

/// Whether `endpoint` is an IPv4 address mapped into IPv6.
bool IsIpv4(const Endpoint& endpoint);

/// "192.168.1.20:9763", "[fe80::1]:9763".
std::string Format(const Endpoint& endpoint);

}  // namespace kinescope::mvn
