#include "server/app/convert/frame_index.h"

#include <algorithm>
#include <cmath>

#include "core/system/clocks.h"

namespace kinescope::app {

std::int64_t FrameIndex::Next(const BodySample& sample) {
  if (!index_) {
    first_stamp_ = sample.stamp_nanos;
    index_ = 0;
  } else {
    constexpr double kFarthest = 1e6;  // frames; farther is another stream
    const double counted = static_cast<double>(sample.counter - last_counter_) / step_;
    const double by_clock = std::max(0.0, Secs(sample.stamp_nanos - last_stamp_) * rate_hz_);
    const bool is_counted = sample.counter > last_counter_ && counted < kFarthest;
    const double frames = is_counted ? counted : std::min(by_clock, kFarthest);
    const std::int64_t step = std::max<std::int64_t>(1, std::llround(frames));
    if (step > 1) {
      const auto missing = static_cast<std::uint64_t>(step - 1);
      missing_frames_ += missing;
      ++holes_;
      if (!longest_ || missing > longest_->frames) {
        longest_ =
            Hole{Secs(last_stamp_ - first_stamp_), Secs(sample.stamp_nanos - last_stamp_), missing};
      }
    }
    *index_ += step;
  }
  last_stamp_ = sample.stamp_nanos;
  last_counter_ = sample.counter;
  return *index_;
}

}  // namespace kinescope::app
