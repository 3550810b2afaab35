#include "server/mvn/clock_fit.h"

#include <algorithm>
#include <cmath>

#include "core/system/clocks.h"

namespace kinescope::mvn {
namespace {

constexpr double kMilliNanos = 1e6;
constexpr std::int64_t kBucketNanos = 2'000'000'000;
constexpr double kPauseNanos = 0.5e9;
constexpr double kTimeCodeJumpNanos = 20e6;
constexpr std::int64_t kMinStepNanos = 100'000;
constexpr std::int64_t kWallSetBackNanos = kNanosPerSecond;

// With fewer samples, the rounding of the time code makes the period too inaccurate.
constexpr std::uint32_t kFramesForPeriod = 8;

// Gain with which the smoothed clock follows the rounded one: an error of 1 ms moves stamps by 1/32
// ms.
constexpr double kGain = 1.0 / 32;

}  // namespace

void ClockFit::Restart() {
  clock_.reset();
  current_.reset();
  previous_.reset();
}

void ClockFit::StartAt(std::uint32_t counter, std::uint32_t time_code_millis) {
  Restart();
  clock_ = SenderClock{counter, time_code_millis, counter, time_code_millis,
                       time_code_millis * kMilliNanos};
}

void ClockFit::Advance(std::uint32_t counter, std::uint32_t time_code_millis) {
  const std::uint32_t frames = counter - clock_->counter;
  const std::uint32_t frames_in_all = counter - clock_->first_counter;
  const double rounded = time_code_millis * kMilliNanos;
  double smooth = rounded;
  if (frames_in_all >= kFramesForPeriod) {
    const double period = (rounded - clock_->first_millis * kMilliNanos) / frames_in_all;
    const double predicted = clock_->smooth_nanos + frames * period;
    if (std::abs(predicted - rounded) > kTimeCodeJumpNanos) {
      return StartAt(counter, time_code_millis);
    }
    // Rounding is less than a millisecond; a larger difference is due to an inaccurate period.
    smooth = std::clamp(predicted + kGain * (rounded - predicted), rounded - kMilliNanos,
                        rounded + kMilliNanos);
  }
  if (time_code_millis < clock_->millis) return StartAt(counter, time_code_millis);
  clock_->counter = counter;
  clock_->millis = time_code_millis;
  clock_->smooth_nanos = smooth;
}

double ClockFit::SmallestOffset(double offset, std::int64_t now) {
  if (current_ &&
      offset - std::min(current_->offset, previous_ ? previous_->offset : offset) > kPauseNanos) {
    current_.reset();
    previous_.reset();
  }
  if (!current_ || now - current_->began >= kBucketNanos) {
    previous_ = current_;
    current_ = Minimum{offset, now};
  }
  current_->offset = std::min(current_->offset, offset);
  return previous_ ? std::min(current_->offset, previous_->offset) : current_->offset;
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
