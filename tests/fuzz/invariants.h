/// What must hold of every sample that any source gives on, whatever it was fed.
#pragma once

#include <cmath>

#include "core/body_sample.h"
#include "core/system/check.h"

namespace kinescope::fuzz {

inline void CheckSample(const BodySample& sample) {
  constexpr double kLargest = 1e6;
  const auto check = [](const Eigen::Vector3d& value) {
    KINESCOPE_CHECK(value.allFinite() && value.cwiseAbs().maxCoeff() <= kLargest);
  };
  for (const SegmentState& segment : sample.segments) {
    check(segment.position);
    check(segment.velocity);
    check(segment.acceleration);
    check(segment.angular_velocity);
    check(segment.angular_acceleration);
    KINESCOPE_CHECK(std::abs(segment.orientation.norm() - 1.0) < 1e-6);
  }
  for (const urdf::Pose& pose : sample.fingers_and_props.poses) {
    check(pose.position);
    KINESCOPE_CHECK(std::abs(pose.orientation.norm() - 1.0) < 1e-6);
  }
  for (const TrackerState& tracker : sample.trackers) {
    check(tracker.free_acceleration);
    check(tracker.acceleration);
    check(tracker.angular_velocity);
    check(tracker.magnetic_field);
    KINESCOPE_CHECK(std::abs(tracker.orientation.norm() - 1.0) < 1e-6);
  }
  if (sample.com) {
    check(sample.com->position);
    check(sample.com->velocity);
    check(sample.com->acceleration);
  }
  if (sample.streamed_angles_deg) {
    for (const Eigen::Vector3d& angles : *sample.streamed_angles_deg) check(angles);
  }
}

}  // namespace kinescope::fuzz
