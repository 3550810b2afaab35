#include "server/app/convert/frame_index.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/system/clocks.h"

namespace kinescope::app {

std::uint32_t CounterStepOf(const std::vector<std::uint32_t>& counters) {
  std::map<std::uint32_t, int> times;  // by step
  for (std::size_t i = 1; i < counters.size(); ++i) {
    if (counters[i] > counters[i - 1]) ++times[counters[i] - counters[i - 1]];
  }
  const auto most = std::max_element(
      times.begin(), times.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == times.end() ? 1 : most->first;
}

std::int64_t FrameIndex::Next(const BodySample& sample) {
  if (!index_) {
    first_stamp_ = sample.stamp_nanos;
    index_ = 0;
  } else {
    constexpr std::uint32_t kFarthest = 1'000'000;  // frames; farther is another stream
    const std::uint32_t counted = sample.counter - last_counter_;
    const double by_clock = std::max(0.0, Secs(sample.stamp_nanos - last_stamp_) * rate_hz_);
    const bool is_counted = sample.counter > last_counter_ && counted / step_ < kFarthest;
    const double frames =
        is_counted ? static_cast<double>(counted) / step_ : std::min<double>(by_clock, kFarthest);
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
