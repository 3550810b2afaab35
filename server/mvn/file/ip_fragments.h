/// Puts IP packets together that were sent in pieces: a datagram of a body with gloves is longer
/// than a packet of the network. Memory is bounded; what cannot be completed is dropped and
/// counted. One thread; time is an argument.
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
  /// Takes a packet of which IsWhole() is false, captured at `now_nanos`. The whole packet once its
  /// last missing piece has come; valid until the next call.
  std::optional<IpPacket> Add(const IpPacket& piece, std::int64_t now_nanos);

  /// Packets that lacked a piece when their time was over, there were too many of them, or (once
  /// Clear() was called) the capture ended; and pieces that contradict their packet.
  std::uint64_t lost() const { return lost_; }

  /// No more pieces will come.
  void Clear();

  static constexpr std::int64_t kPatienceNanos = 30'000'000'000;  // as Linux waits
  static constexpr std::size_t kMostAtOnce = 64;

 private:
  static constexpr std::size_t kMostBytes = 65536;
  static constexpr std::size_t kUnit = 8;  // bytes; offsets are multiples of it

  struct Partial {
    IpPacket head;  // of the first piece met; its payload is not kept
    std::string bytes;
    std::bitset<kMostBytes / kUnit> units;  // that have come
    std::optional<std::size_t> size;        // known once the last piece came
    std::int64_t since_nanos = 0;
  };
  using Partials = std::list<Partial>;  // oldest first

  Partials::iterator Find(const IpPacket& piece);
  void DropOld(std::int64_t now_nanos);

  Partials partials_;
  Partial whole_;  // what was handed out last
  std::uint64_t lost_ = 0;
};

}  // namespace kinescope::mvn
