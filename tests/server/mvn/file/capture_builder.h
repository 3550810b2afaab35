/// Captures by hand, for tests: packets of every kind that a network has, in files of every kind
/// that a capture program writes.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "server/mvn/byte_order.h"
#include "server/mvn/datagram_source.h"
#include "server/mvn/file/packet.h"

namespace kinescope::mvn::testing {

inline Endpoint Ipv4(int last, std::uint16_t port) {  // 10.0.0.last
  Endpoint endpoint;
  endpoint.address = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF, 10, 0, 0};
  endpoint.address[15] = static_cast<std::uint8_t>(last);
  endpoint.port = port;
  return endpoint;
}

inline Endpoint Ipv6(int last, std::uint16_t port) {  // fd00::last
  Endpoint endpoint;
  endpoint.address[0] = 0xFD;
  endpoint.address[15] = static_cast<std::uint8_t>(last);
  endpoint.port = port;
  return endpoint;
}

inline std::string Udp(const Endpoint& from, const Endpoint& to, const std::string& payload) {
  std::string packet;
  WriteUdpPacket(from, to, payload, packet);
  return packet;
}

/// An IPv4 packet without options around `payload`; checksums are 0, as network cards leave them.
inline std::string Ipv4Packet(const Endpoint& from, const Endpoint& to, int protocol, int id,
                              int fragment_word, const std::string& payload) {
  std::string packet;
  ByteWriter out(packet);
  out.Write(std::uint16_t{0x4500});
  out.Write(static_cast<std::uint16_t>(20 + payload.size()));
  out.Write(static_cast<std::uint16_t>(id));
  out.Write(static_cast<std::uint16_t>(fragment_word));
  out.Write(static_cast<std::uint16_t>(0x4000 + protocol));
  out.Write(std::uint16_t{0});
  for (const Endpoint* end : {&from, &to}) {
    packet.append(reinterpret_cast<const char*>(end->address.data()) + 12, 4);
  }
  return packet + payload;
}

/// A whole IPv4 or IPv6 packet in pieces of `size` bytes (a multiple of 8) of payload.
inline std::vector<std::string> Fragments(const std::string& packet, std::size_t size, int id) {
  const bool is_v4 = (packet[0] & 0xF0) == 0x40;
  const std::size_t header = is_v4 ? 20 : 40;
  std::vector<std::string> pieces;
  for (std::size_t at = header; at < packet.size(); at += size) {
    const std::string part = packet.substr(at, size);
    const bool more = at + size < packet.size();
    const std::size_t offset = at - header;
    std::string piece = packet.substr(0, header);
    std::string numbers;
    ByteWriter out(numbers);
    if (is_v4) {
      out.Write(static_cast<std::uint16_t>(header + part.size()));
      out.Write(static_cast<std::uint16_t>(id));
      out.Write(static_cast<std::uint16_t>(offset / 8 | (more ? 0x2000U : 0U)));
      piece.replace(2, numbers.size(), numbers);
    } else {
      out.Write(static_cast<std::uint16_t>(8 + part.size()));
      piece.replace(4, numbers.size(), numbers);
      numbers.clear();
      out.Write(static_cast<std::uint16_t>(static_cast<std::uint8_t>(piece[6]) << 8));
      out.Write(static_cast<std::uint16_t>(offset | (more ? 1U : 0U)));
      out.Write(static_cast<std::uint32_t>(id));
      piece[6] = 44;
      piece += numbers;
    }
    pieces.push_back(piece + part);
  }
  return pieces;
}

enum TcpFlags { kFin = 1, kSyn = 2, kRst = 4, kAck = 16 };

inline std::string Tcp(const Endpoint& from, const Endpoint& to, std::uint32_t sequence, int flags,
                       const std::string& payload) {
  std::string segment;
  ByteWriter out(segment);
  out.Write(from.port);
  out.Write(to.port);
  out.Write(sequence);
  out.Write(std::uint32_t{1});
  out.Write(static_cast<std::uint16_t>(0x8000 | flags));  // 8 words: with 12 bytes of options
  out.Write(std::uint16_t{0xFFFF});
  out.Write(std::uint32_t{0});
  segment.append(12, '\1');
  return Ipv4Packet(from, to, kProtocolTcp, 7, 0x4000, segment + payload);
}

// What goes around an IP packet. `tags` VLAN tags; short frames are padded, as on the wire.
inline std::string Ethernet(const std::string& ip, int tags = 0) {
  std::string frame = "\x02to_us\x02suit";
  frame.resize(12, '\0');
  ByteWriter out(frame);
  for (int i = 0; i < tags; ++i) {
    out.Write(static_cast<std::uint16_t>(i + 1 < tags ? 0x88A8 : 0x8100));
    out.Write(static_cast<std::uint16_t>(100 + i));
  }
  out.Write(static_cast<std::uint16_t>((ip[0] & 0xF0) == 0x40 ? 0x0800 : 0x86DD));
  frame += ip;
  frame.resize(std::max<std::size_t>(frame.size(), 60), '\0');
  return frame;
}

inline std::string LinuxCooked(const std::string& ip) {
  std::string frame;
  ByteWriter out(frame);
  for (const int word : {0, 1, 6, 0x0203, 0x0405, 0x0607, 0}) {
    out.Write(static_cast<std::uint16_t>(word));
  }
  out.Write(static_cast<std::uint16_t>((ip[0] & 0xF0) == 0x40 ? 0x0800 : 0x86DD));
  return frame + ip;
}

inline std::string LinuxCooked2(const std::string& ip) {
  std::string frame;
  ByteWriter out(frame);
  out.Write(static_cast<std::uint16_t>((ip[0] & 0xF0) == 0x40 ? 0x0800 : 0x86DD));
  frame.append(18, '\0');
  return frame + ip;
}

inline std::string Loopback(const std::string& ip) { return std::string("\2\0\0\0", 4) + ip; }

// As files have them, whatever they are called here: LINKTYPE_...
enum LinkType : std::uint32_t {
  kLinkNull = 0,
  kLinkEthernet = 1,
  kLinkRaw = 101,
  kLinkWifi = 105,
  kLinkLoop = 108,
  kLinkCooked = 113,
  kLinkIpv4 = 228,
  kLinkIpv6 = 229,
  kLinkCooked2 = 276,
};

/// The classic format, big-endian, with microseconds or nanoseconds.
class PcapBuilder {
 public:
  explicit PcapBuilder(std::uint32_t link_type, bool has_nanos = true) : has_nanos_(has_nanos) {
    ByteWriter out(bytes_);
    out.Write(has_nanos ? std::uint32_t{0xA1B23C4D} : std::uint32_t{0xA1B2C3D4});
    out.Write(std::uint32_t{0x00020004});
    out.Write(std::uint32_t{0});
    out.Write(std::uint32_t{0});
    out.Write(std::uint32_t{65535});
    out.Write(link_type);
  }

  /// `captured`: fewer bytes than were sent, as with tcpdump -s.
  PcapBuilder& Add(std::int64_t nanos, const std::string& packet,
                   std::size_t captured = std::string::npos) {
    const std::string kept = packet.substr(0, captured);
    ByteWriter out(bytes_);
    out.Write(static_cast<std::uint32_t>(nanos / 1'000'000'000));
    out.Write(static_cast<std::uint32_t>(nanos % 1'000'000'000 / (has_nanos_ ? 1 : 1000)));
    out.Write(static_cast<std::uint32_t>(kept.size()));
    out.Write(static_cast<std::uint32_t>(packet.size()));
    bytes_ += kept;
    return *this;
  }

  const std::string& bytes() const { return bytes_; }

 private:
  bool has_nanos_;
  std::string bytes_;
};

/// pcapng, big-endian, one interface with nanoseconds.
class PcapNgBuilder {
 public:
  explicit PcapNgBuilder(std::uint32_t link_type) {
    std::string body;
    ByteWriter out(body);
    out.Write(std::uint32_t{0x1A2B3C4D});
    out.Write(std::uint32_t{0x00010000});
    out.Write(std::uint32_t{0xFFFFFFFF});  // length of the section: not known
    out.Write(std::uint32_t{0xFFFFFFFF});
    AddBlock(0x0A0D0D0A, body);
    body.clear();
    out.Write(static_cast<std::uint16_t>(link_type));
    out.Write(std::uint16_t{0});
    out.Write(std::uint32_t{65535});
    out.Write(std::uint32_t{0x00090001});  // if_tsresol, one byte: 10^-9 s
    out.Write(std::uint32_t{0x09000000});
    out.Write(std::uint32_t{0});  // end of options
    AddBlock(1, body);
  }

  PcapNgBuilder& Add(std::int64_t nanos, const std::string& packet) {
    std::string body;
    ByteWriter out(body);
    out.Write(std::uint32_t{0});
    out.Write(static_cast<std::uint32_t>(static_cast<std::uint64_t>(nanos) >> 32U));
    out.Write(static_cast<std::uint32_t>(nanos));
    out.Write(static_cast<std::uint32_t>(packet.size()));
    out.Write(static_cast<std::uint32_t>(packet.size()));
    AddBlock(6, body + packet);
    return *this;
  }

  /// A block that a reader has to pass over, such as a comment.
  PcapNgBuilder& AddOther(const std::string& body) {
    AddBlock(0x0BAD, body);
    return *this;
  }

  const std::string& bytes() const { return bytes_; }

 private:
  void AddBlock(std::uint32_t type, std::string body) {
    body.resize((body.size() + 3) / 4 * 4, '\0');
    const auto size = static_cast<std::uint32_t>(body.size() + 12);
    ByteWriter out(bytes_);
    out.Write(type);
    out.Write(size);
    bytes_ += body;
    out.Write(size);
  }

  std::string bytes_;
};

}  // namespace kinescope::mvn::testing
