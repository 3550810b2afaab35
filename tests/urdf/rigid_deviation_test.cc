#include "urdf/rigid_deviation.h"

#include <gtest/gtest.h>

namespace kinescope::urdf {
namespace {

using Eigen::Vector3d;

LinkPoses Bent(const JointAngles& angles) {
  const Pose pelvis = {{1, 2, 0.9}, RotationFromAngles({0.1, 0.2, 2.3})};
  return ForwardKinematics(DefaultSkeleton(), pelvis, angles);
}

JointAngles SomeAngles() {
  JointAngles angles;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double a = 0.1 * static_cast<double>(i);
    angles[i] = {0.5 - a, 0.2 * a, a - 1};
  }
  return angles;
}

TEST(RigidDeviation, IsZeroForARigidBody) {
  const JointAngles angles = SomeAngles();
  const RigidDeviation deviation = MeasureDeviation(DefaultSkeleton(), Bent(angles), angles);
  EXPECT_LT(deviation.LargestPosition(), 1e-12);
  EXPECT_LT(deviation.LargestOrientation(), 1e-7);
}

TEST(RigidDeviation, IsTheDisplacementAndRotationOfEachSegment) {
  const JointAngles angles = SomeAngles();
  LinkPoses measured = Bent(angles);
  measured[kLeftHand].position += Vector3d(0.003, 0, -0.004);
  measured[kLeftFoot].orientation =
      measured[kLeftFoot].orientation * Eigen::AngleAxisd(0.02, Vector3d(1, 2, 3).normalized());
  const RigidDeviation deviation = MeasureDeviation(DefaultSkeleton(), measured, angles);
  for (int segment = 0; segment < kSegmentCount; ++segment) {
    EXPECT_NEAR(deviation.position[At(segment)], segment == kLeftHand ? 0.005 : 0, 1e-12);
    EXPECT_NEAR(deviation.orientation[At(segment)], segment == kLeftFoot ? 0.02 : 0, 1e-7);
  }
}

// A longer upper arm in the URDF moves all that hangs on it, and nothing else.
TEST(RigidDeviation, PropagatesFromAWrongLengthAlongTheChain) {
  const JointAngles angles = SomeAngles();
  Skeleton longer = DefaultSkeleton();
  longer.origin_in_parent[kRightForeArm].z() -= 0.01;
  const RigidDeviation deviation = MeasureDeviation(longer, Bent(angles), angles);
  for (int segment = 0; segment < kSegmentCount; ++segment) {
    const bool hangs_on_it = segment == kRightForeArm || segment == kRightHand;
    EXPECT_NEAR(deviation.position[At(segment)], hangs_on_it ? 0.01 : 0, 1e-12);
  }
}

TEST(RigidDeviation, TakesTheMaximumOfTwoDeviationsPerSegment) {
  RigidDeviation a, b;
  a.position[kHead] = 1;
  a.orientation[kHead] = 2;
  b.position[kHead] = 3;
  b.position[kNeck] = 4;
  a.Raise(b);
  EXPECT_EQ(a.position[kHead], 3);
  EXPECT_EQ(a.position[kNeck], 4);
  EXPECT_EQ(a.orientation[kHead], 2);
  EXPECT_EQ(a.LargestPosition(), 4);
}

}  // namespace
}  // namespace kinescope::urdf
