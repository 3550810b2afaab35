#include "server/ros/ros_clock.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/system/clocks.h"

namespace kinescope::ros_bridge {
namespace {

constexpr std::int64_t kWindow = 2 * kNanosPerSecond;     // of the wall clock
constexpr std::int64_t kShortest = kNanosPerSecond / 10;  // of ticks that show a rate
constexpr std::int64_t kLargestGap = kNanosPerSecond / 4;
// A step by more than this, and by more than so many times the wall clock's, is a jump.
constexpr std::int64_t kJump = 5 * kNanosPerSecond;
constexpr std::int64_t kFastest = 20;
constexpr double kSlowest = 1e-3;

}  // namespace

void RosClock::Observe(std::int64_t wall_nanos, std::int64_t ros_nanos) {
  if (ros_nanos <= 0) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!ticks_.empty()) {
    const Tick& last = ticks_.back();
    const std::int64_t step = ros_nanos - last.ros_nanos, waited = wall_nanos - last.wall_nanos;
    if (step == 0) return;
    if (step < 0 || waited < 0 || (step > kJump && step / kFastest > waited)) {
      ticks_.clear();
      ++jumps_;
    }
  }
  ticks_.push_back({wall_nanos, ros_nanos});
  while (wall_nanos - ticks_.front().wall_nanos > kWindow) ticks_.pop_front();
  Fit();
}

void RosClock::Fit() {
  const Tick first = ticks_.front(), last = ticks_.back();
  const std::int64_t wall = last.wall_nanos - first.wall_nanos;
  rate_ = 1;
  if (wall >= kShortest) {
    rate_ = std::max(kSlowest, static_cast<double>(last.ros_nanos - first.ros_nanos) /
                                   static_cast<double>(wall));
  }
  double above = 0;  // the newest tick
  std::int64_t gap = 0;
  for (std::size_t i = 0; i < ticks_.size(); ++i) {
    const auto wall_before = static_cast<double>(last.wall_nanos - ticks_[i].wall_nanos);
    const auto ros_before = static_cast<double>(last.ros_nanos - ticks_[i].ros_nanos);
    above = std::max(above, rate_ * wall_before - ros_before);
    if (i > 0) gap = std::max(gap, ticks_[i].ros_nanos - ticks_[i - 1].ros_nanos);
  }
  gap = std::min(gap, kLargestGap);
  base_wall_ = last.wall_nanos;
  base_ros_ = last.ros_nanos + std::min<std::int64_t>(std::llround(above), gap);
  latest_ = last.ros_nanos + gap;
}

bool RosClock::has_time() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return !ticks_.empty();
}

std::optional<std::int64_t> RosClock::ToRos(std::int64_t wall_nanos) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (ticks_.empty()) return std::nullopt;
  const auto since = static_cast<double>(wall_nanos - base_wall_);
  return std::min<std::int64_t>(latest_, base_ros_ + std::llround(rate_ * since));
}

std::int64_t RosClock::FromRos(std::int64_t ros_nanos) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (ticks_.empty()) return ros_nanos;
  return base_wall_ + std::llround(static_cast<double>(ros_nanos - base_ros_) / rate_);
}

int RosClock::jumps() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return jumps_;
}

}  // namespace kinescope::ros_bridge
