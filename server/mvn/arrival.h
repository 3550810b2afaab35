/// Receive time of a datagram: the same instant on both clocks.
#pragma once

#include <cstdint>

namespace kinescope::mvn {

struct Arrival {
  std::int64_t monotonic_nanos = 0;  // monotonic clock, for intervals: never steps
  std::int64_t wall_nanos = 0;       // wall clock, Unix epoch, for stamps: may step
};

}  // namespace kinescope::mvn
