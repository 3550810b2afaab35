#include "server/mvn/endpoint.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <algorithm>

namespace kinescope::mvn {
namespace {

constexpr std::array<std::uint8_t, 12> kIpv4Prefix = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF};

}  // namespace

bool IsIpv4(const Endpoint& endpoint) {
  return std::equal(kIpv4Prefix.begin(), kIpv4Prefix.end(), endpoint.address.begin());
}

std::string Format(const Endpoint& endpoint) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  const std::string port = ":" + std::to_string(endpoint.port);
  if (IsIpv4(endpoint)) {
    inet_ntop(AF_INET, endpoint.address.data() + kIpv4Prefix.size(), text.data(), text.size());
    return text.data() + port;
  }
  inet_ntop(AF_INET6, endpoint.address.data(), text.data(), text.size());
  return "[" + std::string(text.data()) + "]" + port;
}

}  // namespace kinescope::mvn
