#include "server/mvn/udp_url.h"

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <cstring>
#include <memory>

#include "server/core/errors.h"

namespace kinescope::mvn {
namespace {

constexpr std::string_view kScheme = "udp://";
constexpr int kLargestPort = 65535;

[[noreturn]] void Refuse(std::string_view url, const std::string& why) {
  throw SourceError(std::string(url) + ": " + why);
}

std::uint16_t ParsePort(std::string_view url, std::string_view text) {
  int port = 0;
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, port);
  if (text.empty() || parsed.ec == std::errc::invalid_argument || parsed.ptr != end) {
    Refuse(url, "'" + std::string(text) + "' is no port; expected a whole number, such as 9763");
  }
  if (parsed.ec != std::errc() || port < 0 || port > kLargestPort) {
    Refuse(url, "port " + std::string(text) +
                    " is out of range; ports are 1 to 65535 (MVN sends to 9763), "
                    "and 0 takes a free one");
  }
  return static_cast<std::uint16_t>(port);
}

SocketAddress Resolve(const UdpUrl& url, const std::string& text, int flags, const char* way_out) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = flags;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(url.host.c_str(), std::to_string(url.port).c_str(), &hints, &found);
  if (error != 0) {
    Refuse(text, "'" + url.host + "' is no address (" + gai_strerror(error) + "); " + way_out);
  }
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, &freeaddrinfo);
  SocketAddress address;
  address.size = found->ai_addrlen;
  std::memcpy(&address.storage, found->ai_addr, found->ai_addrlen);
  return address;
}

}  // namespace

UdpUrl ParseUdpUrl(std::string_view url) {
  if (url.substr(0, kScheme.size()) != kScheme) {
    Refuse(url, "no UDP address; expected udp://host:port, such as udp://:9763");
  }
  std::string_view rest = url.substr(kScheme.size());
  UdpUrl parsed;
  if (!rest.empty() && rest.front() == '[') {
    const std::size_t bracket = rest.find(']');
    if (bracket == std::string_view::npos) {
      Refuse(url, "the bracket is not closed; expected udp://[::1]:9763");
    }
    parsed.host = rest.substr(1, bracket - 1);
    rest.remove_prefix(bracket + 1);
    if (!rest.empty() && rest.front() != ':') {
      Refuse(url, "'" + std::string(rest) + "' after the bracket; expected udp://[::1]:9763");
    }
  } else {
    const std::size_t colon = rest.find(':');
    parsed.host = rest.substr(0, colon);
    rest.remove_prefix(parsed.host.size());
    if (rest.find(':', 1) != std::string_view::npos) {
      Refuse(url, "an IPv6 address needs brackets: udp://[::1]:9763");
    }
  }
  if (parsed.host.find_first_of("/ \t\r\n?#@") != std::string::npos) {
    Refuse(url, "'" + parsed.host + "' is no host; expected udp://host:port, such as udp://:9763");
  }
  if (!rest.empty()) parsed.port = ParsePort(url, rest.substr(1));
  return parsed;
}

SocketAddress ResolveToListen(const UdpUrl& url, const std::string& text) {
  UdpUrl numeric = url;
  if (numeric.host.empty()) numeric.host = "0.0.0.0";
  if (numeric.host == "localhost") numeric.host = "127.0.0.1";
  return Resolve(numeric, text, AI_NUMERICHOST | AI_NUMERICSERV,
                 "give an address of this machine in numbers, or none to listen on all of them: "
                 "udp://:9763");
}

SocketAddress ResolveToSend(const UdpUrl& url, const std::string& text) {
  if (url.port == 0) Refuse(text, "port 0 cannot be sent to; MVN receivers listen on 9763");
  if (url.host.empty()) {
    Refuse(text, "no host to send to; expected udp://127.0.0.1:9763 or another machine's name");
  }
  return Resolve(url, text, AI_NUMERICSERV, "check the name, or give the address in numbers");
}

std::string FormatUdpUrl(const SocketAddress& address) {
  std::array<char, INET6_ADDRSTRLEN> host{};
  if (address.storage.ss_family == AF_INET6) {
    const auto& ip = reinterpret_cast<const sockaddr_in6&>(address.storage);
    inet_ntop(AF_INET6, &ip.sin6_addr, host.data(), host.size());
    return "udp://[" + std::string(host.data()) + "]:" + std::to_string(ntohs(ip.sin6_port));
  }
  const auto& ip = reinterpret_cast<const sockaddr_in&>(address.storage);
  inet_ntop(AF_INET, &ip.sin_addr, host.data(), host.size());
  return "udp://" + std::string(host.data()) + ":" + std::to_string(ntohs(ip.sin_port));
}

Socket::~Socket() {
  if (descriptor_ >= 0) close(descriptor_);
}

}  // namespace kinescope::mvn
