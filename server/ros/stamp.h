/// Converts between the stamp of a sample and ROS time. Pure functions, any thread.
#pragma once

#include <ros/time.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include "core/body_sample.h"
#include "core/system/clocks.h"

namespace kinescope::ros_bridge {

/// `nanos` since the Unix epoch as ROS time. Values that ROS time cannot represent (before 1970,
/// after 2106) become the nearest one: a stamp in a file is untrusted.
inline ros::Time ToRosTime(std::int64_t stamp_nanos) {
  constexpr std::int64_t kLast =
      std::int64_t{std::numeric_limits<std::uint32_t>::max()} * kNanosPerSecond +
      (kNanosPerSecond - 1);
  const std::int64_t nanos = std::clamp<std::int64_t>(stamp_nanos, 0, kLast);
  return {static_cast<std::uint32_t>(nanos / kNanosPerSecond),
          static_cast<std::uint32_t>(nanos % kNanosPerSecond)};
}

inline std::int64_t ToNanos(const ros::Time& time) {
  return std::int64_t{time.sec} * kNanosPerSecond + std::int64_t{time.nsec};
}

inline ros::Time StampOf(const BodySample& sample) { return ToRosTime(sample.stamp_nanos); }

}  // namespace kinescope::ros_bridge
