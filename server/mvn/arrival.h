/// When a datagram came, on both clocks: the same instant.
#pragma once

#include <cstdint>

namespace kinescope::mvn {

struct Arrival {
  std::int64_t monotonic_nanos = 0;  // for intervals: never steps
  std::int64_t wall_nanos = 0;       // Unix epoch, for stamps: may step
};

}  // namespace kinescope::mvn
