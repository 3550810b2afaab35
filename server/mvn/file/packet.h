/// Parses and writes the IP packets of capture files. The input is untrusted: every length is
/// checked before anything is read. Pure functions, any thread; views point into the argument.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "server/mvn/endpoint.h"

namespace kinescope::mvn {

/// Why a packet gives no result.
enum class PacketFault {
  kOther,     // another protocol, or invalid
  kCutShort,  // the capture contains only a part of the packet
};

struct Fragment {
  std::uint32_t id = 0;
  std::size_t offset = 0;  // of this payload in the complete packet; a multiple of 8
  bool more_follow = false;

  bool IsWhole() const { return offset == 0 && !more_follow; }
};

struct IpPacket {
  Endpoint from, to;  // port 0: it is in the payload
  std::uint8_t protocol = 0;
  Fragment fragment;
  std::string_view payload;
};

inline constexpr std::uint8_t kProtocolTcp = 6;
inline constexpr std::uint8_t kProtocolUdp = 17;

/// Whether FindIp() supports packets of a libpcap link type (DLT_...): Ethernet, Linux "cooked"
/// (any interface), raw IP, BSD loopback.
bool KnowsLinkType(int link_type);

/// The IP packet in a captured packet; VLAN tags are skipped.
/// @pre KnowsLinkType(link_type)
[[nodiscard]] tl::expected<std::string_view, PacketFault> FindIp(int link_type,
                                                                 std::string_view captured);

/// Parses IPv4 or IPv6 with any options and extension headers.
[[nodiscard]] tl::expected<IpPacket, PacketFault> ParseIp(std::string_view bytes);

struct UdpPacket {
  Endpoint from, to;
  std::string_view payload;
};
/// @pre packet.protocol == kProtocolUdp and the packet is complete.
[[nodiscard]] tl::expected<UdpPacket, PacketFault> ParseUdp(const IpPacket& packet);

struct TcpSegment {
  Endpoint from, to;
  std::uint32_t sequence = 0;  // of the first byte of payload
  bool is_first = false;       // SYN: the connection begins here
  bool is_last = false;        // FIN or RST: this side sends nothing after the payload
  bool is_reset = false;       // RST: missing bytes will not be sent
  std::string_view payload;
};
/// @pre packet.protocol == kProtocolTcp and the packet is complete.
[[nodiscard]] tl::expected<TcpSegment, PacketFault> ParseTcp(const IpPacket& packet);

/// The most that one UDP packet carries over IPv4 or IPv6.
inline constexpr std::size_t kMaxUdpPayload = 65507;

/// Writes an IP packet with a UDP datagram and checksums to `out`: IPv4 if both ends are IPv4, else
/// IPv6. An unknown end (all zero) is written as 0.0.0.0 or :: and is read as unknown again.
/// @pre payload.size() <= kMaxUdpPayload
void WriteUdpPacket(const Endpoint& from, const Endpoint& to, std::string_view payload,
                    std::string& out);

}  // namespace kinescope::mvn
