/// Converts the kernel's time stamp of a datagram, which is on the wall clock, to its receive time
/// on both clocks. The age of a datagram that has waited for a busy reader is thus known, however
/// long it waited. The wall clock may be set in between: then the stamp is on the clock before or
/// after that step, whichever makes the receive time possible. Limits: a datagram that waited while
/// the clock was set twice, or by less than 20 ms, may be dated wrong by that step; without stamps
/// the time of reading is all there is. One thread.
#pragma once

#include <sys/socket.h>

#include <cstdint>
#include <optional>

#include "core/system/wall_offset.h"
#include "server/mvn/arrival.h"
#include "server/mvn/net/socket.h"

namespace kinescope::mvn {

/// Makes the kernel stamp what `socket` receives. It may refuse: then there are no stamps.
void StampArrivals(const Socket& socket);
/// That of what recvmsg() read; nullopt: there is none.
std::optional<std::int64_t> KernelStampOf(const msghdr& message);

class ArrivalClock {
 public:
  /// `opened`: when the socket was opened; nothing arrived before.
  explicit ArrivalClock(const Arrival& opened)
      : offset_(opened.wall_nanos, opened.monotonic_nanos),
        offset_before_nanos_(offset_.nanos()),
        last_nanos_(opened.monotonic_nanos) {}

  /// Call it after each read from the socket, before ArrivalOf(). Returns by how much the wall
  /// clock was set since the call before, ns; 0 if it was not (below 20 ms it is corrected
  /// gradually).
  std::int64_t Read(const Arrival& now);

  /// Receive time of the next datagram. `stamp_nanos`: of the kernel; nullopt: it made none, so the
  /// time of reading is taken. The monotonic time is never before that of an earlier datagram nor
  /// after the time of reading; the wall time is on today's clock.
  Arrival ArrivalOf(std::optional<std::int64_t> stamp_nanos);

 private:
  std::int64_t MonotonicOf(std::int64_t stamp_nanos) const;

  Arrival now_;
  WallOffset offset_;
  std::int64_t offset_before_nanos_;  // before the wall clock was last set
  std::int64_t last_nanos_;           // receive time of the datagram before
};

}  // namespace kinescope::mvn
