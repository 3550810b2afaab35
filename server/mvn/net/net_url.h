/// Parses `udp://host:port` and `tcp://host:port`, for receivers and senders. Pure functions, any
/// thread.
///
///   udp://:9763                   every IPv4 address of this machine (a sender needs a host)
///   udp://127.0.0.1               one address; the default port is MVN's, 9763
///   udp://[::1]:9763              IPv6 addresses are in brackets
///   udp://[::]:9763               every address, IPv6 and IPv4
///   tcp://:9763  tcp://[::]       no host, or an address that means "every": waits for connections
///   tcp://192.168.1.20:9763       a host: connects to it
///   tcp://127.0.0.1:9763?listen   waits for connections at this address only
///   tcp://suit-pc:9763?connect    connects; the same as without ?connect
///   udp://:9763?from=10.0.0.0/8   receives from these machines only (core/system/ip_networks.h)
///   tcp://:9763?listen&from=...   several of these are separated by &
///
/// "localhost" is 127.0.0.1, so that both ends mean the same address. A listener with port 0 gets a
/// free port.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/system/ip_networks.h"

namespace kinescope::mvn {

inline constexpr std::uint16_t kDefaultPort = 9763;

enum class Protocol { kUdp, kTcp };

struct NetUrl {
  /// TCP: which end makes the connection. Without meaning for UDP, where it is kListen.
  enum class Mode { kListen, kConnect };

  Protocol protocol = Protocol::kUdp;
  std::string host;  // "" for all IPv4 addresses of this machine; no brackets
  std::uint16_t port = kDefaultPort;
  Mode mode = Mode::kListen;
  IpNetworks from;        // of a receiver; empty: all
  std::string from_text;  // as it was written; "": all senders
};

/// Whether `url` begins with "udp:" or "tcp:" and can be passed to ParseNetUrl().
bool IsNetUrl(std::string_view url);

/// Does not query a name service.
/// @throws SourceError with the URL, the error and the expected form.
NetUrl ParseNetUrl(std::string_view url);

/// "udp" or "tcp".
const char* Scheme(Protocol protocol);

}  // namespace kinescope::mvn
