/// A list of IP addresses and networks, as options name them. A plain value, any thread.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinescope {

/// IPv6 in network byte order; an IPv4 address is mapped into it (::ffff:a.b.c.d).
using IpAddress = std::array<std::uint8_t, 16>;

class IpNetworks {
 public:
  IpNetworks() = default;  // none
  /// `text`: addresses and networks with commas in between, "192.168.1.20,10.0.0.0/8,fe80::/10".
  /// @throws std::invalid_argument with the wrong part and what was expected
  explicit IpNetworks(std::string_view text);

  bool Has(const IpAddress& address) const;
  bool empty() const { return networks_.empty(); }

 private:
  struct Network {
    IpAddress address{};
    int bits = 128;  // of the address that count
  };
  static Network Parse(const std::string& text);

  std::vector<Network> networks_;
};

}  // namespace kinescope
