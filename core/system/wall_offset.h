/// Follows the wall clock of this computer and notices when it is set. One thread.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/system/clocks.h"

namespace kinescope {

class WallOffset {
 public:
  /// Both clocks at one moment, ns, as in Read.
  WallOffset(std::int64_t wall_nanos, std::int64_t monotonic_nanos)
      : nanos_(wall_nanos - monotonic_nanos) {}

  /// Returns by how much the wall clock was set since the call before, ns; 0 if it was not: what is
  /// below 20 ms is followed, as a clock is that is corrected gradually.
  std::int64_t Read(std::int64_t wall_nanos, std::int64_t monotonic_nanos) {
    constexpr std::int64_t kStep = 20 * kNanosPerMilli;
    const std::int64_t change = wall_nanos - monotonic_nanos - nanos_;
    nanos_ += change;
    return std::abs(change) > kStep ? change : 0;
  }

  /// Wall clock minus monotonic clock when both were last read, ns.
  std::int64_t nanos() const { return nanos_; }

 private:
  std::int64_t nanos_;
};

}  // namespace kinescope
