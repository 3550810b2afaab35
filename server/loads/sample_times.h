/// Gives every sample the time to the next one. Plain data; one thread.
#pragma once

#include <cstdint>

#include "server/loads/gap.h"

namespace kinescope::loads {

/// After a gap of more than 0.5 s or a step back in time, a sample has the time of the step before:
/// nothing is known about the time between.
class SampleTimes {
 public:
  /// Adds a sample. Returns the time of the one before, ns; 0 for the first.
  std::int64_t Add(std::int64_t stamp_nanos) {
    constexpr auto kLongestStepNanos = static_cast<std::int64_t>(kLongestGapSecs * 1e9);
    const bool is_first = !has_last_;
    const std::int64_t step = stamp_nanos - last_nanos_;
    continues_ = !is_first && step >= 0 && step <= kLongestStepNanos;
    if (continues_) step_nanos_ = step;
    has_last_ = true;
    last_nanos_ = stamp_nanos;
    return is_first ? 0 : step_nanos_;
  }
  /// The time of the last one: that of the one before.
  std::int64_t Last() const { return step_nanos_; }
  /// Whether the newest sample continues the one before.
  bool continues() const { return continues_; }

 private:
  bool has_last_ = false, continues_ = false;
  std::int64_t last_nanos_ = 0, step_nanos_ = 0;
};

}  // namespace kinescope::loads
