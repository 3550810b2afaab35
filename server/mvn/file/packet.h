/// Internet packets in a capture file: taken apart, and put together. Untrusted: every length is
/// checked before anything is read. Pure functions, any thread; views point into what was given.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "server/mvn/endpoint.h"

namespace kinescope::mvn {

/// Why a packet gives nothing.
enum class PacketFault {
  kOther,     // not what is asked for: another protocol, or nothing that makes sense
  kCutShort,  // more of it was on the wire than is in the file
};

struct Fragment {
  std::uint32_t id = 0;
  std::size_t offset = 0;  // of the payload in the whole; a multiple of 8
  bool more_follow = false;

  bool IsWhole() const { return offset == 0 && !more_follow; }
};

struct IpPacket {
  Endpoint from, to;  // port 0: it stands in the payload
  std::uint8_t protocol = 0;
  Fragment fragment;
  std::string_view payload;
};

inline constexpr std::uint8_t kProtocolTcp = 6;
inline constexpr std::uint8_t kProtocolUdp = 17;

/// Whether FindIp() knows packets of a libpcap link type (DLT_...): Ethernet, Linux "cooked" (any
/// interface), raw IP, BSD loopback.
bool KnowsLinkType(int link_type);

/// The IP packet in a captured one; VLAN tags are passed over.
/// @pre KnowsLinkType(link_type)
[[nodiscard]] tl::expected<std::string_view, PacketFault> FindIp(int link_type,
                                                                 std::string_view captured);

/// IPv4 or IPv6, whatever options and extension headers it has.
[[nodiscard]] tl::expected<IpPacket, PacketFault> ParseIp(std::string_view bytes);

struct UdpPacket {
  Endpoint from, to;
  std::string_view payload;
};
/// @pre packet.protocol == kProtocolUdp and the packet is no mere fragment.
[[nodiscard]] tl::expected<UdpPacket, PacketFault> ParseUdp(const IpPacket& packet);

struct TcpSegment {
  Endpoint from, to;
  std::uint32_t sequence = 0;  // of the first byte of payload
  bool is_first = false;       // SYN: the connection begins here
  bool is_last = false;        // FIN or RST: this side ends with the payload
  bool is_reset = false;       // RST: what is missing will not come
  std::string_view payload;
};
/// @pre packet.protocol == kProtocolTcp and the packet is no mere fragment.
[[nodiscard]] tl::expected<TcpSegment, PacketFault> ParseTcp(const IpPacket& packet);

/// The most that one UDP packet carries over IPv4 or IPv6.
inline constexpr std::size_t kMostUdpPayload = 65507;

/// `out` becomes an IP packet with a UDP datagram, checksums included: IPv4 where both ends are,
/// else IPv6. An unknown end (all zero) is 0.0.0.0 or ::, and comes back as such.
/// @pre payload.size() <= kMostUdpPayload
void WriteUdpPacket(const Endpoint& from, const Endpoint& to, std::string_view payload,
                    std::string& out);

}  // namespace kinescope::mvn
