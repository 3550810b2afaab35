/// Measures how far a captured human is from the rigid one of the URDF. MVN's segments shift
/// relative to each other by millimetres (the spine is interpolated, sensors slide on skin).
/// Published poses stay as measured, so a reader that uses only joint states and URDF sees the body
/// with this deviation.
/// Pure functions, any thread.
#pragma once

#include <array>

#include "urdf/kinematics.h"
#include "urdf/skeleton.h"

namespace kinescope::urdf {

/// By segment, which is joint + 1; 0 for the pelvis, the root of the chain.
struct RigidDeviation {
  std::array<double, kSegmentCount> position{};     // of the segment's origin, m
  std::array<double, kSegmentCount> orientation{};  // rad

  /// Raises each segment's values to those of `other` where these are larger.
  void Raise(const RigidDeviation& other);
  /// The largest of all segments.
  double LargestPosition() const;
  double LargestOrientation() const;
};

/// Deviation between `measured` and the rigid human with the measured pelvis, bent by `angles`.
RigidDeviation MeasureDeviation(const Skeleton& skeleton, const LinkPoses& measured,
                                const JointAngles& angles);

}  // namespace kinescope::urdf
