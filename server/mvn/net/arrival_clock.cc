#include "server/mvn/net/arrival_clock.h"

#include <time.h>

#include <algorithm>
#include <cstring>

#include "core/system/clocks.h"

namespace kinescope::mvn {

void StampArrivals(const Socket& socket) {
  const int on = 1;
  setsockopt(socket.get(), SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
}

std::optional<std::int64_t> KernelStampOf(const msghdr& message) {
  msghdr header = message;
  for (cmsghdr* control = CMSG_FIRSTHDR(&header); control != nullptr;
       control = CMSG_NXTHDR(&header, control)) {
    if (control->cmsg_level != SOL_SOCKET || control->cmsg_type != SO_TIMESTAMPNS) continue;
    timespec stamp{};
    std::memcpy(&stamp, CMSG_DATA(control), sizeof stamp);
    return stamp.tv_sec * kNanosPerSecond + stamp.tv_nsec;
  }
  return std::nullopt;
}

std::int64_t ArrivalClock::Read(const Arrival& now) {
  now_ = now;
  const std::int64_t before = offset_.nanos();
  const std::int64_t set_by = offset_.Read(now.wall_nanos, now.monotonic_nanos);
  if (set_by != 0) offset_before_nanos_ = before;
  return set_by;
}

std::int64_t ArrivalClock::MonotonicOf(std::int64_t stamp_nanos) const {
  // The kernel stamps and the two clocks are read at different instants.
  constexpr std::int64_t kSlack = 2 * kNanosPerMilli;
  for (const std::int64_t offset : {offset_.nanos(), offset_before_nanos_}) {
    const std::int64_t nanos = stamp_nanos - offset;
    if (nanos >= last_nanos_ - kSlack && nanos <= now_.monotonic_nanos + kSlack) return nanos;
  }
  return stamp_nanos - offset_.nanos();
}

Arrival ArrivalClock::ArrivalOf(std::optional<std::int64_t> stamp_nanos) {
  const std::int64_t newest = std::max(now_.monotonic_nanos, last_nanos_);
  last_nanos_ = stamp_nanos ? std::clamp(MonotonicOf(*stamp_nanos), last_nanos_, newest) : newest;
  return {last_nanos_, now_.wall_nanos - (now_.monotonic_nanos - last_nanos_)};
}

}  // namespace kinescope::mvn
