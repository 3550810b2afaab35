#include "core/system/ip_networks.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <stdexcept>

namespace kinescope {
namespace {

constexpr int kIpv4Bits = 32, kIpv6Bits = 128;

[[noreturn]] void RefuseNetwork(const std::string& text) {
  throw std::invalid_argument(
      "'" + text +
      "' is not an address or network; expected such as 192.168.1.20, 10.0.0.0/8 or fe80::/10, "
      "with commas between several");
}

}  // namespace

IpNetworks::IpNetworks(std::string_view text) {
  while (true) {
    const std::size_t comma = std::min(text.find(','), text.size());
    networks_.push_back(Parse(std::string(text.substr(0, comma))));
    if (comma == text.size()) return;
    text.remove_prefix(comma + 1);
  }
}

IpNetworks::Network IpNetworks::Parse(const std::string& text) {
  const std::size_t slash = std::min(text.find('/'), text.size());
  const std::string host = text.substr(0, slash);
  Network network;
  int width = kIpv6Bits;
  in_addr ipv4{};
  if (inet_pton(AF_INET, host.c_str(), &ipv4) == 1) {
    width = kIpv4Bits;
    network.address[10] = network.address[11] = 0xFF;
    std::memcpy(network.address.data() + 12, &ipv4, sizeof ipv4);
  } else if (inet_pton(AF_INET6, host.c_str(), network.address.data()) != 1) {
    RefuseNetwork(text);
  }
  if (slash == text.size()) return network;
  int bits = -1;
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data() + slash + 1, end, bits);
  if (parsed.ec != std::errc() || parsed.ptr != end || bits < 0 || bits > width) {
    RefuseNetwork(text);
  }
  network.bits = kIpv6Bits - width + bits;
  return network;
}

bool IpNetworks::Has(const IpAddress& address) const {
  const auto has = [&](const Network& network) {
    for (int bit = 0; bit < network.bits; bit += 8) {
      const auto byte = static_cast<std::size_t>(bit / 8);
      const int counts = std::min(network.bits - bit, 8);
      const unsigned mask = 0xFFu << (8 - counts) & 0xFFu;
      if (((address[byte] ^ network.address[byte]) & mask) != 0) return false;
    }
    return true;
  };
  return std::any_of(networks_.begin(), networks_.end(), has);
}

}  // namespace kinescope
