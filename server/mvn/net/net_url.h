/// `udp://host:port` and `tcp://host:port`, for receivers and senders alike.
///
///   udp://:9763                   every IPv4 address of this machine (a sender needs a host)
///   udp://127.0.0.1               one address; without a port it is 9763, MVN's own
///   udp://[::1]:9763              IPv6 addresses stand in brackets
///   udp://[::]:9763               every address, IPv6 and IPv4
///   tcp://:9763  tcp://[::]       no host, or an address that means "every": waits for connections
///   tcp://192.168.1.20:9763       a host: connects to it
///   tcp://127.0.0.1:9763?listen   waits for connections at this address only
///   tcp://suit-pc:9763?connect    connects; for completeness
///
/// "localhost" is 127.0.0.1, so that both ends mean the same address. Port 0 takes a free one where
/// something listens.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace kinescope::mvn {

inline constexpr std::uint16_t kDefaultPort = 9763;

enum class Protocol { kUdp, kTcp };

struct NetUrl {
  /// TCP: who makes the connection. UDP has none; there it is kListen and means nothing.
  enum class Mode { kListen, kConnect };

  Protocol protocol = Protocol::kUdp;
  std::string host;  // "" for all IPv4 addresses of this machine; no brackets
  std::uint16_t port = kDefaultPort;
  Mode mode = Mode::kListen;
};

/// Whether `url` begins with "udp:" or "tcp:", and so is for ParseNetUrl().
bool IsNetUrl(std::string_view url);

/// Pure: asks no name service.
/// @throws SourceError naming the URL, what is wrong with it and what would be right.
NetUrl ParseNetUrl(std::string_view url);

/// "udp" or "tcp".
const char* Scheme(Protocol protocol);

}  // namespace kinescope::mvn
