/// How far a measured human is from the rigid one of the URDF. MVN's segments shift against each
/// other by millimetres (the spine is interpolated, sensors slide on skin); published poses stay as
/// measured, so a reader of joint states and URDF alone sees the body this much elsewhere.
/// Pure functions, any thread.
#pragma once

#include <array>

#include "urdf/kinematics.h"
#include "urdf/skeleton.h"

namespace kinescope::urdf {

/// By segment, which is by joint + 1; the pelvis, where the chain is hung, has 0.
struct RigidDeviation {
  std::array<double, kSegmentCount> position{};     // of the segment's origin, m
  std::array<double, kSegmentCount> orientation{};  // rad

  /// Takes what is larger in `other`, segment by segment.
  void Raise(const RigidDeviation& other);
  /// The largest of all segments.
  double LargestPosition() const;
  double LargestOrientation() const;
};

/// Between `measured` and the rigid human hung at the measured pelvis and bent by `angles`.
RigidDeviation MeasureDeviation(const Skeleton& skeleton, const LinkPoses& measured,
                                const JointAngles& angles);

}  // namespace kinescope::urdf
