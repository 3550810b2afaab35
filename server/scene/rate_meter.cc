#include "server/scene/rate_meter.h"

#include "core/system/clocks.h"

namespace kinescope::app {

void RateMeter::Add(const BodySample& sample) {
  const bool is_file = sample.arrival_nanos == 0;
  if (is_file && nominal_hz_ > 0) {
    hz_ = nominal_hz_;
    return;
  }
  const std::int64_t now = is_file ? sample.stamp_nanos : sample.arrival_nanos;
  const double secs = window_ ? Secs(now - window_->start_nanos) : 0;
  constexpr double kLongestWindow = 2;  // the person whose samples are counted has left
  if (!window_ || secs > kLongestWindow) {
    window_ = Window{now, sample.character, 0};
    return;
  }
  if (sample.character != window_->character) return;
  ++window_->samples;
  // Not sooner, not even the first time: samples that waited in the socket while the program
  // started come at once, and would be a quarter of a short window.
  if (secs >= 1.0) {
    hz_ = window_->samples / secs;
    window_->start_nanos = now;
    window_->samples = 0;
  }
}

void RateMeter::Stop() {
  hz_ = 0;
  window_.reset();
}

}  // namespace kinescope::app
