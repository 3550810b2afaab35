#include "server/mvn/clock_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/system/clocks.h"

namespace kinescope::mvn {
namespace {

constexpr double kMilliNanos = 1e6;
constexpr std::int64_t kBucketNanos = 250'000'000;
constexpr std::size_t kBuckets = 16;
constexpr std::size_t kMinimaForDrift = 3;
constexpr double kDrift = 0.02;  // less is the jitter of a network, or no matter
constexpr double kPauseNanos = 0.5e9;
constexpr double kTimeCodeJumpNanos = 20e6;
constexpr std::int64_t kMinStepNanos = 100'000;
constexpr std::int64_t kWallSetBackNanos = kNanosPerSecond;

// The smoothed clock is a line through the time codes, of all samples at first and then of about so
// many.
constexpr std::uint32_t kMemory = 256;
constexpr std::uint32_t kSamplesForJump = 8;  // with fewer, rounding makes the line too inaccurate
// Until then the line may be most of a millisecond early or late, and what was measured with it is
// forgotten after that.
constexpr std::uint32_t kSamplesToSettle = 32;

}  // namespace

void ClockFit::Restart() {
  clock_.reset();
  minima_.clear();
  drift_ = 0;
}

void ClockFit::StartAt(std::uint32_t counter, std::uint32_t time_code_millis) {
  Restart();
  const double nanos = time_code_millis * kMilliNanos;
  clock_ = SenderClock{1, counter, time_code_millis, nanos, 0, false};
}

// The gains are those of the least-squares line through n samples when the newest one is added
// (growing-memory filter: E. Brookner, Tracking and Kalman Filtering Made Easy, 1998, chapter 1).
void ClockFit::Advance(std::uint32_t counter, std::uint32_t time_code_millis) {
  const std::uint32_t frames = std::max(counter - clock_->counter, 1U);
  const double rounded = time_code_millis * kMilliNanos;
  const double predicted = clock_->smooth_nanos + frames * clock_->period_nanos;
  const double error = rounded - predicted;
  const bool jumps = clock_->samples >= kSamplesForJump && std::abs(error) > kTimeCodeJumpNanos;
  if (jumps || time_code_millis < clock_->millis) return StartAt(counter, time_code_millis);
  clock_->samples = std::min(clock_->samples + 1, kMemory);
  const double n = clock_->samples;
  const double gain = 2 * (2 * n - 1) / (n * (n + 1)), period_gain = 6 / (n * (n + 1));
  clock_->counter = counter;
  clock_->millis = time_code_millis;
  // Rounding is less than a millisecond.
  clock_->smooth_nanos =
      std::clamp(predicted + gain * error, rounded - kMilliNanos, rounded + kMilliNanos);
  clock_->period_nanos += period_gain * error / frames;
}

// The median of the slopes of all pairs (Theil and Sen): a few slow samples do not change it.
void ClockFit::MeasureDrift() {
  std::array<double, kBuckets*(kBuckets - 1) / 2> slopes{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < minima_.size(); ++i) {
    for (std::size_t k = i + 1; k < minima_.size(); ++k) {
      const double sent = minima_[k].sender_nanos - minima_[i].sender_nanos;
      if (sent > 0) slopes[count++] = (minima_[k].offset - minima_[i].offset) / sent;
    }
  }
  drift_ = 0;
  if (minima_.size() < kMinimaForDrift || count == 0) return;
  double* const middle = slopes.data() + count / 2;
  std::nth_element(slopes.data(), middle, slopes.data() + count);
  if (*middle > kDrift) drift_ = *middle;
}

double ClockFit::SmallestOffset(double offset, std::int64_t now) {
  const double sender_nanos = clock_->smooth_nanos;
  const auto expected = [&] {  // the smallest offset of the window, as it would be now
    double smallest = offset;
    for (const Minimum& minimum : minima_) {
      smallest =
          std::min(smallest, minimum.offset + drift_ * (sender_nanos - minimum.sender_nanos));
    }
    return smallest;
  };
  const double delay = offset - expected();
  const bool has_just_settled = !clock_->has_settled && clock_->samples >= kSamplesToSettle &&
                                delay < kMilliNanos && drift_ == 0;
  if (has_just_settled) clock_->has_settled = true;
  if (has_just_settled || delay > kPauseNanos) {
    minima_.clear();
    drift_ = 0;
  }
  if (minima_.empty() || now - minima_.back().began >= kBucketNanos) {
    minima_.reserve(kBuckets);  // once: nothing is allocated per sample
    if (minima_.size() == kBuckets) minima_.erase(minima_.begin());
    minima_.push_back({offset, sender_nanos, now});
    MeasureDrift();
  } else if (offset - drift_ * (sender_nanos - minima_.back().sender_nanos) <
             minima_.back().offset) {
    minima_.back().offset = offset;
    minima_.back().sender_nanos = sender_nanos;
  }
  return expected();
}

std::int64_t ClockFit::Stamp(std::uint32_t counter, std::uint32_t time_code_millis,
                             const Arrival& arrival) {
  const bool stands_still =
      clock_ && counter != clock_->counter && time_code_millis == clock_->millis;
  std::int64_t stamp = arrival.wall_nanos;
  if (!clock_ || stands_still) {
    StartAt(counter, time_code_millis);
  } else {
    Advance(counter, time_code_millis);
  }
  if (!stands_still) {
    // On the monotonic clock, so that setting the wall clock does not disturb the fit.
    const double offset = static_cast<double>(arrival.monotonic_nanos) - clock_->smooth_nanos;
    const double delay = offset - SmallestOffset(offset, arrival.monotonic_nanos);
    stamp -= static_cast<std::int64_t>(delay);
  }
  const bool wall_set_back = arrival.wall_nanos < last_wall_ - kWallSetBackNanos;
  if (last_stamp_ && !wall_set_back) stamp = std::max(stamp, *last_stamp_ + kMinStepNanos);
  last_stamp_ = stamp;
  last_wall_ = arrival.wall_nanos;
  return stamp;
}

}  // namespace kinescope::mvn
