#include "server/mvn/net/net_url.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include "core/system/errors.h"
#include "core/system/starts_with.h"

namespace kinescope::mvn {
namespace {

constexpr int kLargestPort = 65535;

[[noreturn]] void RefuseUrl(std::string_view url, const std::string& why) {
  throw SourceError(std::string(url) + ": " + why);
}

std::uint16_t ParsePort(std::string_view url, std::string_view text) {
  int port = 0;
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, port);
  if (text.empty() || parsed.ec == std::errc::invalid_argument || parsed.ptr != end) {
    RefuseUrl(url, "invalid port '" + std::string(text) + "'; expected a number, such as 9763");
  }
  if (parsed.ec != std::errc() || port < 0 || port > kLargestPort) {
    RefuseUrl(
        url, "port " + std::string(text) +
                 " is out of range; expected 1 to 65535 (MVN sends to 9763), or 0 for a free port");
  }
  return static_cast<std::uint16_t>(port);
}

// An address that means all addresses of this machine, in any spelling.
bool IsAnyAddress(const std::string& host) {
  in_addr ipv4{};
  in6_addr ipv6{};
  return host.empty() ||
         (inet_pton(AF_INET, host.c_str(), &ipv4) == 1 && ipv4.s_addr == INADDR_ANY) ||
         (inet_pton(AF_INET6, host.c_str(), &ipv6) == 1 && IN6_IS_ADDR_UNSPECIFIED(&ipv6));
}

// Divides "host:port": `rest` is the part after the scheme, without a query.
void ParseHostAndPort(std::string_view url, std::string_view rest, NetUrl& parsed) {
  const std::string scheme = Scheme(parsed.protocol);
  if (!rest.empty() && rest.front() == '[') {
    const std::size_t bracket = rest.find(']');
    if (bracket == std::string_view::npos) {
      RefuseUrl(url, "the bracket is not closed; expected " + scheme + "://[::1]:9763");
    }
    parsed.host = rest.substr(1, bracket - 1);
    rest.remove_prefix(bracket + 1);
    if (!rest.empty() && rest.front() != ':') {
      RefuseUrl(url, "unexpected '" + std::string(rest) + "' after the bracket; expected " +
                         scheme + "://[::1]:9763");
    }
  } else {
    const std::size_t colon = rest.find(':');
    parsed.host = rest.substr(0, colon);
    rest.remove_prefix(parsed.host.size());
    if (rest.find(':', 1) != std::string_view::npos) {
      RefuseUrl(url, "an IPv6 address needs brackets: " + scheme + "://[::1]:9763");
    }
  }
  if (parsed.host.find_first_of("/ \t\r\n?#@") != std::string::npos) {
    RefuseUrl(url, "invalid host name '" + parsed.host + "'; expected " + scheme +
                       "://host:port, such as " + scheme + "://:9763");
  }
  if (!rest.empty()) parsed.port = ParsePort(url, rest.substr(1));
}

NetUrl::Mode ModeWithoutQuery(const NetUrl& parsed) {
  const bool listens = parsed.protocol == Protocol::kUdp || IsAnyAddress(parsed.host);
  return listens ? NetUrl::Mode::kListen : NetUrl::Mode::kConnect;
}

// `word`: of a query, such as "listen".
NetUrl::Mode ParseMode(std::string_view url, std::string_view word, const NetUrl& parsed) {
  using Mode = NetUrl::Mode;
  if (word != "listen" && word != "connect") {
    RefuseUrl(url, "unknown query '?" + std::string(word) +
                       "'; expected ?listen, ?connect, ?from=ADDRESS/n or nothing");
  }
  if (parsed.protocol == Protocol::kUdp) {
    RefuseUrl(url, "UDP has no connections; remove '?" + std::string(word) + "', or use tcp://");
  }
  if (word == "listen") return Mode::kListen;
  if (IsAnyAddress(parsed.host)) {
    RefuseUrl(
        url, "the host is missing; expected a host to connect to, such as tcp://192.168.1.20:9763");
  }
  return Mode::kConnect;
}

// `query`: "?listen&from=10.0.0.0/8", or empty.
void ParseQuery(std::string_view url, std::string_view query, NetUrl& parsed) {
  constexpr std::string_view kFrom = "from=";
  parsed.mode = ModeWithoutQuery(parsed);
  while (!query.empty()) {
    query.remove_prefix(1);  // ? or &
    const std::string_view word = query.substr(0, query.find('&'));
    query.remove_prefix(word.size());
    if (!StartsWith(word, kFrom)) {
      parsed.mode = ParseMode(url, word, parsed);
      continue;
    }
    parsed.from_text = word.substr(kFrom.size());
    try {
      parsed.from = IpNetworks(parsed.from_text);
    } catch (const std::invalid_argument& error) {
      RefuseUrl(url, "from=" + std::string(error.what()));
    }
  }
  if (parsed.mode == NetUrl::Mode::kConnect && !parsed.from.empty()) {
    RefuseUrl(url, "connects to one machine, so from= has no meaning; remove it, or add ?listen");
  }
}

}  // namespace

const char* Scheme(Protocol protocol) { return protocol == Protocol::kUdp ? "udp" : "tcp"; }

bool IsNetUrl(std::string_view url) { return StartsWith(url, "udp:") || StartsWith(url, "tcp:"); }

NetUrl ParseNetUrl(std::string_view url) {
  constexpr std::size_t kPrefixBytes = 6;  // "udp://"
  const std::string_view prefix = url.substr(0, kPrefixBytes);
  if (prefix != "udp://" && prefix != "tcp://") {
    RefuseUrl(url,
              "not a network address; expected udp://host:port or tcp://host:port, such as "
              "udp://:9763");
  }
  NetUrl parsed;
  parsed.protocol = prefix == "udp://" ? Protocol::kUdp : Protocol::kTcp;
  const std::string_view rest = url.substr(kPrefixBytes);
  const std::size_t query = std::min(rest.find('?'), rest.size());
  ParseHostAndPort(url, rest.substr(0, query), parsed);
  ParseQuery(url, rest.substr(query), parsed);
  return parsed;
}

}  // namespace kinescope::mvn
