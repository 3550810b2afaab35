/// Assembles fragmented IP packets: a datagram of a body with gloves is longer than a network
/// packet. Memory is limited; incomplete packets are dropped and counted. One thread; time is an
/// argument.
#pragma once

#include <bitset>
#include <cstdint>
#include <list>
#include <optional>
#include <string>

#include "server/mvn/file/packet.h"

namespace kinescope::mvn {

class IpFragments {
 public:
  /// Adds a fragment (IsWhole() is false) captured at `now_nanos`. Returns the complete packet once
  /// its last missing fragment is added; valid until the next call.
  std::optional<IpPacket> Add(const IpPacket& piece, std::int64_t now_nanos);

  /// Number of lost packets: incomplete when their time was over, when there were too many, or when
  /// the capture ended (after Clear()); and fragments that contradict their packet.
  std::uint64_t lost() const { return lost_; }

  /// End of the capture.
  void Clear();

  static constexpr std::int64_t kPatienceNanos = 30'000'000'000;  // as in Linux
  static constexpr std::size_t kMaxAtOnce = 64;

 private:
  static constexpr std::size_t kMaxBytes = 65536;
  static constexpr std::size_t kUnit = 8;  // bytes; offsets are multiples of it

  struct Partial {
    IpPacket head;  // of the first fragment received, without its payload
    std::string bytes;
    std::bitset<kMaxBytes / kUnit> units;  // received so far
    std::optional<std::size_t> size;       // known once the last fragment is received
    std::int64_t since_nanos = 0;
  };
  using Partials = std::list<Partial>;  // oldest first

  Partials::iterator Find(const IpPacket& piece);
  void DropOld(std::int64_t now_nanos);

  Partials partials_;
  Partial whole_;  // the packet returned last
  std::uint64_t lost_ = 0;
};

}  // namespace kinescope::mvn
