#include "server/mvn/file/packet.h"

#include <pcap/dlt.h>

#include <algorithm>
#include <cstring>

#include "core/system/check.h"
#include "server/mvn/byte_order.h"

namespace kinescope::mvn {
namespace {

constexpr std::uint16_t kEtherIpv4 = 0x0800;
constexpr std::uint16_t kEtherIpv6 = 0x86DD;
constexpr std::size_t kIpv4Bytes = 20;
constexpr std::size_t kIpv6Bytes = 40;
constexpr std::size_t kUdpBytes = 8;
constexpr std::size_t kTcpBytes = 20;
constexpr int kMaxTags = 4;         // VLAN in VLAN has two
constexpr int kMaxExtensions = 16;  // a valid packet has two or three

template <class T>
using Parsed = tl::expected<T, PacketFault>;

tl::unexpected<PacketFault> Other() { return tl::make_unexpected(PacketFault::kOther); }
tl::unexpected<PacketFault> CutShort() { return tl::make_unexpected(PacketFault::kCutShort); }

// The bytes after an EtherType, with VLAN tags skipped.
Parsed<std::string_view> AfterEtherType(std::uint16_t type, std::string_view rest) {
  ByteReader in(rest);
  for (int tags = 0; type == 0x8100 || type == 0x88A8 || type == 0x9100; ++tags) {
    std::uint16_t tag = 0;
    if (tags == kMaxTags) return Other();
    if (!in.Read(tag) || !in.Read(type)) return CutShort();
  }
  if (type != kEtherIpv4 && type != kEtherIpv6) return Other();
  return rest.substr(in.offset());
}

// A header of `size` bytes that has an EtherType at `type_at`.
Parsed<std::string_view> AfterHeader(std::string_view captured, std::size_t size,
                                     std::size_t type_at) {
  if (captured.size() < size) return CutShort();
  ByteReader in(captured);
  std::uint16_t type = 0;
  if (!in.Seek(type_at) || !in.Read(type)) return CutShort();
  return AfterEtherType(type, captured.substr(size));
}

Endpoint EndpointFrom(std::string_view address) {
  Endpoint endpoint;
  if (address.size() == endpoint.address.size()) {
    std::memcpy(endpoint.address.data(), address.data(), address.size());
  } else if (address.find_first_not_of('\0') != std::string_view::npos) {  // 0.0.0.0: unknown
    endpoint.address[10] = endpoint.address[11] = 0xFF;
    std::memcpy(endpoint.address.data() + 12, address.data(), address.size());
  }
  return endpoint;
}

Parsed<IpPacket> ParseIpv4(std::string_view bytes) {
  ByteReader in(bytes);
  std::uint8_t version_and_words = 0;
  std::uint16_t total = 0, id = 0, fragment = 0;
  IpPacket packet;
  std::string_view from, to, skipped;
  const bool whole = in.Read(version_and_words) && in.ReadBytes(1, skipped) && in.Read(total) &&
                     in.Read(id) && in.Read(fragment) && in.ReadBytes(1, skipped) &&
                     in.Read(packet.protocol) && in.ReadBytes(2, skipped) &&
                     in.ReadBytes(4, from) && in.ReadBytes(4, to);
  if (!whole) return CutShort();
  const std::size_t header = 4U * (version_and_words & 0xFU);
  const bool is_offloaded = total == 0;  // captured before the network card divided it into packets
  const std::size_t size = is_offloaded ? bytes.size() : total;
  if (header < kIpv4Bytes || size < header) return Other();
  if (bytes.size() < size) return CutShort();
  packet.from = EndpointFrom(from);
  packet.to = EndpointFrom(to);
  packet.fragment = {id, 8U * (fragment & 0x1FFFU), (fragment & 0x2000U) != 0};
  packet.payload = bytes.substr(header, size - header);  // without the padding of short frames
  return packet;
}

enum Extension : std::uint8_t {
  kHopByHop = 0,
  kRouting = 43,
  kFragment = 44,
  kAuthentication = 51,
  kDestination = 60,
  kMobility = 135,
};

// Skips the extension headers; packet.protocol is the next header.
Parsed<IpPacket> SkipExtensions(IpPacket packet) {
  for (int i = 0; i < kMaxExtensions; ++i) {
    std::size_t unit = 8;
    std::size_t extra = 8;  // the length does not count the first 8 bytes
    switch (packet.protocol) {
      case kAuthentication: unit = 4; break;
      case kHopByHop:
      case kRouting:
      case kFragment:
      case kDestination:
      case kMobility: break;
      default: return packet;
    }
    ByteReader in(packet.payload);
    std::uint8_t next = 0, length = 0;
    if (!in.Read(next) || !in.Read(length)) return CutShort();
    std::size_t size = unit * length + extra;
    if (packet.protocol == kFragment) {
      std::uint16_t place = 0;
      if (!in.Read(place) || !in.Read(packet.fragment.id)) return CutShort();
      packet.fragment.offset = place & 0xFFF8U;
      packet.fragment.more_follow = (place & 1U) != 0;
      size = 8;
    }
    if (packet.payload.size() < size) return CutShort();
    const bool is_later_fragment = packet.protocol == kFragment && packet.fragment.offset > 0;
    packet.payload.remove_prefix(size);
    packet.protocol = next;
    if (is_later_fragment) return packet;  // not followed by a header
  }
  return Other();
}

Parsed<IpPacket> ParseIpv6(std::string_view bytes) {
  ByteReader in(bytes);
  std::uint32_t version_and_flow = 0;
  std::uint16_t size = 0;
  std::uint8_t hops = 0;
  IpPacket packet;
  std::string_view from, to;
  if (!in.Read(version_and_flow) || !in.Read(size) || !in.Read(packet.protocol) || !in.Read(hops) ||
      !in.ReadBytes(16, from) || !in.ReadBytes(16, to)) {
    return CutShort();
  }
  const bool is_offloaded = size == 0;
  packet.payload = bytes.substr(kIpv6Bytes);
  if (!is_offloaded) {
    if (packet.payload.size() < size) return CutShort();
    packet.payload = packet.payload.substr(0, size);
  }
  packet.from = EndpointFrom(from);
  packet.to = EndpointFrom(to);
  return SkipExtensions(packet);
}

bool IsUnknown(const Endpoint& endpoint) { return endpoint.address == Endpoint().address; }

// The Internet checksum: bytes as big-endian 16-bit words, added with carry.
std::uint32_t AddWords(std::string_view bytes, std::uint32_t sum) {
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const auto byte = static_cast<std::uint8_t>(bytes[i]);
    sum += i % 2 == 0 ? static_cast<std::uint32_t>(byte) << 8U : byte;
  }
  return sum;
}

std::uint16_t Checksum(std::uint32_t sum) {
  while (sum >> 16U != 0) sum = (sum & 0xFFFFU) + (sum >> 16U);
  return static_cast<std::uint16_t>(~sum & 0xFFFFU);
}

void Patch(std::string& bytes, std::size_t at, std::uint16_t value) {
  bytes[at] = static_cast<char>(value >> 8U);
  bytes[at + 1] = static_cast<char>(value & 0xFFU);
}

std::string_view AddressBytes(const Endpoint& endpoint, bool as_ipv4) {
  const std::string_view all(reinterpret_cast<const char*>(endpoint.address.data()),
                             endpoint.address.size());
  return as_ipv4 ? all.substr(12) : all;
}

}  // namespace

bool KnowsLinkType(int link_type) {
  switch (link_type) {
    case DLT_EN10MB:
    case DLT_LINUX_SLL:
    case DLT_LINUX_SLL2:
    case DLT_RAW:
    case DLT_IPV4:
    case DLT_IPV6:
    case DLT_NULL:
    case DLT_LOOP: return true;
    default: return false;
  }
}

tl::expected<std::string_view, PacketFault> FindIp(int link_type, std::string_view captured) {
  switch (link_type) {
    case DLT_EN10MB: return AfterHeader(captured, 14, 12);
    case DLT_LINUX_SLL: return AfterHeader(captured, 16, 14);
    case DLT_LINUX_SLL2: return AfterHeader(captured, 20, 0);
    // Begins with an address family whose number and byte order depend on the machine; the IP
    // version gives the same information.
    case DLT_NULL:
    case DLT_LOOP:
      if (captured.size() < 4) return CutShort();
      return captured.substr(4);
    default: return captured;
  }
}

tl::expected<IpPacket, PacketFault> ParseIp(std::string_view bytes) {
  if (bytes.empty()) return CutShort();
  switch (static_cast<std::uint8_t>(bytes[0]) >> 4U) {
    case 4: return ParseIpv4(bytes);
    case 6: return ParseIpv6(bytes);
    default: return Other();
  }
}

tl::expected<UdpPacket, PacketFault> ParseUdp(const IpPacket& packet) {
  KINESCOPE_CHECK(packet.protocol == kProtocolUdp && packet.fragment.IsWhole());
  UdpPacket udp{packet.from, packet.to, {}};
  ByteReader in(packet.payload);
  std::uint16_t size = 0, checksum = 0;
  if (!in.Read(udp.from.port) || !in.Read(udp.to.port) || !in.Read(size) || !in.Read(checksum)) {
    return CutShort();
  }
  udp.payload = packet.payload.substr(kUdpBytes);
  if (size == 0) return udp;  // offloaded, as with IP
  if (size < kUdpBytes) return Other();
  if (packet.payload.size() < size) return CutShort();
  udp.payload = udp.payload.substr(0, size - kUdpBytes);
  return udp;
}

tl::expected<TcpSegment, PacketFault> ParseTcp(const IpPacket& packet) {
  KINESCOPE_CHECK(packet.protocol == kProtocolTcp && packet.fragment.IsWhole());
  TcpSegment segment;
  segment.from = packet.from;
  segment.to = packet.to;
  ByteReader in(packet.payload);
  std::uint32_t acknowledged = 0;
  std::uint16_t words_and_flags = 0;
  if (!in.Read(segment.from.port) || !in.Read(segment.to.port) || !in.Read(segment.sequence) ||
      !in.Read(acknowledged) || !in.Read(words_and_flags)) {
    return CutShort();
  }
  const std::size_t header = 4U * (words_and_flags >> 12U);
  if (header < kTcpBytes) return Other();
  if (packet.payload.size() < header) return CutShort();
  segment.payload = packet.payload.substr(header);
  segment.is_first = (words_and_flags & 0x02U) != 0;
  segment.is_reset = (words_and_flags & 0x04U) != 0;
  segment.is_last = segment.is_reset || (words_and_flags & 0x01U) != 0;
  if (segment.is_first) ++segment.sequence;  // a SYN counts as one byte
  return segment;
}

void WriteUdpPacket(const Endpoint& from, const Endpoint& to, std::string_view payload,
                    std::string& out) {
  KINESCOPE_CHECK(payload.size() <= kMaxUdpPayload);
  const bool as_ipv4 = (IsIpv4(from) || IsUnknown(from)) && (IsIpv4(to) || IsUnknown(to));
  const auto udp_size = static_cast<std::uint16_t>(kUdpBytes + payload.size());
  out.clear();
  ByteWriter writer(out);
  if (as_ipv4) {
    writer.Write(std::uint32_t{0x45000000U | static_cast<std::uint32_t>(kIpv4Bytes + udp_size)});
    writer.Write(std::uint32_t{0x00004000});                         // id 0, do not fragment
    writer.Write(std::uint32_t{0x40000000U | kProtocolUdp << 16U});  // 64 hops; checksum follows
  } else {
    writer.Write(std::uint32_t{0x60000000});
    writer.Write(
        std::uint32_t{static_cast<std::uint32_t>(udp_size) << 16U | kProtocolUdp << 8U | 64U});
  }
  const std::string_view from_bytes = AddressBytes(from, as_ipv4);
  const std::string_view to_bytes = AddressBytes(to, as_ipv4);
  out.append(from_bytes).append(to_bytes);
  if (as_ipv4) Patch(out, 10, Checksum(AddWords(out, 0)));
  const std::size_t udp_at = out.size();
  for (const std::uint16_t word : {from.port, to.port, udp_size, std::uint16_t{0}}) {
    writer.Write(word);
  }
  out.append(payload);
  // Also over addresses, protocol and length.
  std::uint32_t sum = AddWords(from_bytes, AddWords(to_bytes, kProtocolUdp + udp_size));
  sum = AddWords(std::string_view(out).substr(udp_at), sum);
  const std::uint16_t checksum = Checksum(sum);
  Patch(out, udp_at + 6, checksum == 0 ? 0xFFFF : checksum);  // 0 would mean: none
}

}  // namespace kinescope::mvn
