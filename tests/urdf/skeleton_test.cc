#include "urdf/skeleton.h"

#include <gtest/gtest.h>

namespace kinescope::urdf {
namespace {

using Eigen::Vector3d;

TEST(Segments, KnowBothNamesOfTheClavicleJoint) {
  EXPECT_EQ(FindJoint("jRightT4Shoulder"), jRightC7Shoulder);
  EXPECT_EQ(FindJoint("jRightC7Shoulder"), jRightC7Shoulder);
  EXPECT_EQ(FindJoint("jTail"), std::nullopt);
  EXPECT_EQ(FindSegment("LeftForeArm"), kLeftForeArm);
  EXPECT_EQ(FindSegment("leftforearm"), std::nullopt);
}

TEST(Segments, HangTheArmsOfTheTPoseInTheNPose) {
  // In the T-pose the right arm lies along -y of its segment frame; in its link frame along -z.
  EXPECT_LT((SegmentFromLink(kRightForeArm) * Vector3d(0, 0, -1) - Vector3d(0, -1, 0)).norm(),
            1e-15);
  EXPECT_LT((SegmentFromLink(kLeftHand) * Vector3d(0, 0, -1) - Vector3d(0, 1, 0)).norm(), 1e-15);
}

TEST(Skeleton, DefaultIsAsTallAsAsked) {
  for (const double height : {1.50, 1.75, 1.95}) {
    const Skeleton skeleton = DefaultSkeleton(height);
    const auto origins = NPoseOrigins(skeleton);
    const double top = origins[kHead].z() + skeleton.head_top_in_head.z();
    EXPECT_NEAR(top, height, 0.002 * height);
    EXPECT_EQ(skeleton.height, height);
  }
}

// The T-pose of a skeleton, in segment frames, as type 13 would send it.
std::array<Vector3d, kSegmentCount> TPoseOrigins(const Skeleton& skeleton) {
  std::array<Vector3d, kSegmentCount> origins;
  origins[0] = {0, 0, 1};
  for (int i = 1; i < kSegmentCount; ++i) {
    const int parent = kSegments[static_cast<std::size_t>(i)].parent;
    origins[static_cast<std::size_t>(i)] =
        origins[static_cast<std::size_t>(parent)] +
        SegmentFromLink(parent) * skeleton.origin_in_parent[static_cast<std::size_t>(i)];
  }
  return origins;
}

TEST(Skeleton, ComesBackFromItsOwnTPoseAndLandmarks) {
  const Skeleton skeleton = DefaultSkeleton(1.8);
  Landmarks landmarks;
  landmarks[{kHead, "pTopOfHead"}] = skeleton.head_top_in_head;
  landmarks[{kRightHand, "pRightTopOfHand"}] =
      SegmentFromLink(kRightHand) * skeleton.finger_tip_in_hand[kRight];
  landmarks[{kLeftHand, "pLeftTopOfHand"}] =
      SegmentFromLink(kLeftHand) * skeleton.finger_tip_in_hand[kLeft];
  landmarks[{kRightFoot, "pRightHeelFoot"}] = skeleton.heel_in_foot[kRight];
  landmarks[{kLeftFoot, "pLeftHeelFoot"}] = skeleton.heel_in_foot[kLeft];
  landmarks[{kRightToe, "pRightToe"}] = skeleton.toe_tip_in_toe[kRight];
  landmarks[{kLeftToe, "pLeftToe"}] = skeleton.toe_tip_in_toe[kLeft];
  const Skeleton back = SkeletonFromTPose(TPoseOrigins(skeleton), landmarks);
  for (std::size_t i = 0; i < kSegmentCount; ++i) {
    EXPECT_LT((back.origin_in_parent[i] - skeleton.origin_in_parent[i]).norm(), 1e-12);
  }
  EXPECT_LT((back.finger_tip_in_hand[kLeft] - skeleton.finger_tip_in_hand[kLeft]).norm(), 1e-12);
  EXPECT_NEAR(back.height, 1.8, 0.004);
}

TEST(Skeleton, GuessesMissingEndPointsFromStature) {
  const Skeleton skeleton = DefaultSkeleton(1.8);
  const Skeleton back = SkeletonFromTPose(TPoseOrigins(skeleton), {});
  EXPECT_NEAR(back.height, 1.8, 0.01);
  EXPECT_NEAR(back.head_top_in_head.z(), skeleton.head_top_in_head.z(), 0.01);
  EXPECT_NEAR(back.finger_tip_in_hand[kRight].z(), skeleton.finger_tip_in_hand[kRight].z(), 0.01);
  EXPECT_NEAR(back.heel_in_foot[kLeft].z(), skeleton.heel_in_foot[kLeft].z(), 0.01);
  EXPECT_GT(back.toe_tip_in_toe[kRight].x(), 0.05);
}

TEST(Skeleton, NamesTheJointThatTheLandmarksLack) {
  try {
    SkeletonFromLandmarks({});
    FAIL() << "accepted a body without joints";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "segment Pelvis has no point 'jL5S1'");
  }
}

}  // namespace
}  // namespace kinescope::urdf
