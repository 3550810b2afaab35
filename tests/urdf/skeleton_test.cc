#include <gtest/gtest.h>

#include <string>

#include "urdf/landmarks.h"

namespace kinescope::urdf {
namespace {

using Eigen::Vector3d;

TEST(Segments, AcceptBothNamesOfTheClavicleJoint) {
  EXPECT_EQ(FindJoint("jRightT4Shoulder"), jRightC7Shoulder);
  EXPECT_EQ(FindJoint("jRightC7Shoulder"), jRightC7Shoulder);
  EXPECT_EQ(FindJoint("jTail"), std::nullopt);
  EXPECT_EQ(FindSegment("LeftForeArm"), kLeftForeArm);
  EXPECT_EQ(FindSegment("leftforearm"), std::nullopt);
}

TEST(Joints, OfBothSidesAreInOneGroup) {
  for (int right = 0; right < kJointCount; ++right) {
    const std::string name(kJoints[At(right)].ros_name);
    EXPECT_EQ(IsLeftJoint(right), name.substr(0, 5) == "left_") << name;
    if (name.substr(0, 6) != "right_") continue;
    int left = 0;
    while (left < kJointCount && kJoints[At(left)].ros_name != "left_" + name.substr(6)) ++left;
    ASSERT_LT(left, kJointCount) << name;
    EXPECT_EQ(JointGroupOf(left), JointGroupOf(right)) << name;
  }
  EXPECT_EQ(JointGroupOf(jRightKnee), JointGroup::kKnee);
  EXPECT_EQ(JointGroupOf(jLeftC7Shoulder), JointGroup::kClavicle);
  EXPECT_EQ(JointGroupOf(jRightBallFoot), JointGroup::kBallOfFoot);
  EXPECT_EQ(JointGroupOf(jC1Head), JointGroup::kNeck);
}

TEST(Segments, HaveTheL5S1LoadAtItsIndex) { EXPECT_EQ(kScoredJoints[kScoredL5S1], jL5S1); }

TEST(Segments, TurnTheArmsFromTheTPoseToTheNPose) {
  // In the T-pose the right arm lies along -y of its segment frame; in its link frame along -z.
  EXPECT_LT((SegmentFromLink(kRightForeArm) * Vector3d(0, 0, -1) - Vector3d(0, -1, 0)).norm(),
            1e-15);
  EXPECT_LT((SegmentFromLink(kLeftHand) * Vector3d(0, 0, -1) - Vector3d(0, 1, 0)).norm(), 1e-15);
}

TEST(Skeleton, HasTheRequestedHeight) {
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
  origins[0] = NPoseOrigins(skeleton)[0];  // the legs are as in the N-pose
  for (int i = 1; i < kSegmentCount; ++i) {
    const int parent = kSegments[static_cast<std::size_t>(i)].parent;
    origins[static_cast<std::size_t>(i)] =
        origins[static_cast<std::size_t>(parent)] +
        SegmentFromLink(parent) * skeleton.origin_in_parent[static_cast<std::size_t>(i)];
  }
  return origins;
}

TEST(Skeleton, IsRestoredFromItsOwnTPoseAndLandmarks) {
  const Skeleton skeleton = DefaultSkeleton(1.8);
  Landmarks landmarks;
  landmarks.push_back({kHead, 1, "pTopOfHead", skeleton.head_top_in_head});
  landmarks.push_back({kRightHand, 1, "pRightTopOfHand",
                       SegmentFromLink(kRightHand) * skeleton.finger_tip_in_hand[kRight]});
  landmarks.push_back({kLeftHand, 1, "pLeftTopOfHand",
                       SegmentFromLink(kLeftHand) * skeleton.finger_tip_in_hand[kLeft]});
  landmarks.push_back({kRightFoot, 1, "pRightHeelFoot", skeleton.heel_in_foot[kRight]});
  landmarks.push_back({kLeftFoot, 1, "pLeftHeelFoot", skeleton.heel_in_foot[kLeft]});
  landmarks.push_back({kRightToe, 1, "pRightToe", skeleton.toe_tip_in_toe[kRight]});
  landmarks.push_back({kLeftToe, 1, "pLeftToe", skeleton.toe_tip_in_toe[kLeft]});
  const Skeleton back = SkeletonFromTPose(TPoseOrigins(skeleton), landmarks);
  for (std::size_t i = 0; i < kSegmentCount; ++i) {
    EXPECT_LT((back.origin_in_parent[i] - skeleton.origin_in_parent[i]).norm(), 1e-12);
  }
  EXPECT_LT((back.finger_tip_in_hand[kLeft] - skeleton.finger_tip_in_hand[kLeft]).norm(), 1e-12);
  EXPECT_NEAR(back.height, 1.8, 0.004);
}

TEST(Skeleton, EstimatesMissingEndPointsFromTheBonesBesideThem) {
  const Skeleton skeleton = DefaultSkeleton(1.8);
  const Skeleton back = SkeletonFromTPose(TPoseOrigins(skeleton), {});
  EXPECT_TRUE(back.ends_are_estimated);
  EXPECT_NEAR(back.height, 1.8, 0.01);
  EXPECT_NEAR(back.head_top_in_head.z(), skeleton.head_top_in_head.z(), 0.01);
  EXPECT_NEAR(back.finger_tip_in_hand[kRight].z(), skeleton.finger_tip_in_hand[kRight].z(), 0.003);
  EXPECT_NEAR(back.heel_in_foot[kLeft].z(), skeleton.heel_in_foot[kLeft].z(), 0.003);
  EXPECT_GT(back.toe_tip_in_toe[kRight].x(), 0.05);
}

TEST(Skeleton, PrefersJointsOfTheLandmarksToThoseOfTheTPose) {
  const Skeleton skeleton = DefaultSkeleton(1.8);
  auto origins = TPoseOrigins(skeleton);
  for (int i = kL5; i <= kLeftHand; ++i) origins[At(i)].x() -= 0.0125;  // all that L5 carries
  Landmarks landmarks;
  landmarks.push_back({kPelvis, 1, "jL5S1", skeleton.origin_in_parent[kL5]});
  landmarks.push_back({kT8, 1, "jRightT4Shoulder",
                       skeleton.origin_in_parent[kRightShoulder] + Vector3d(0, 0, 0.002)});
  landmarks.push_back({kL5, 1, "jL4L3", Vector3d(0, 0.4, 0.4)});  // that is no joint
  const Skeleton told = SkeletonFromTPose(origins, landmarks);
  EXPECT_EQ(told.origin_in_parent[kL5], skeleton.origin_in_parent[kL5]);
  EXPECT_EQ(told.origin_in_parent[kRightShoulder],
            skeleton.origin_in_parent[kRightShoulder] + Vector3d(0, 0, 0.002));
  EXPECT_LT((told.origin_in_parent[kL3] - skeleton.origin_in_parent[kL3]).norm(), 1e-12);
}

TEST(Skeleton, PutsSolesWithoutLandmarksOnTheFloorOfTheTPose) {
  const Skeleton skeleton = DefaultSkeleton(1.9);
  const Skeleton back = SkeletonFromTPose(TPoseOrigins(skeleton), {});
  for (const Side side : {kRight, kLeft}) {
    EXPECT_NEAR(back.heel_in_foot[side].z(), skeleton.heel_in_foot[side].z(), 1e-12);
    EXPECT_NEAR(back.toe_tip_in_toe[side].z(), skeleton.toe_tip_in_toe[side].z(), 1e-12);
  }
}

TEST(Skeleton, IgnoresTheFloorBelowATPoseThatIsInTheAir) {
  auto origins = TPoseOrigins(DefaultSkeleton(1.8));
  for (Vector3d& origin : origins) origin.z() += 0.3;
  const Skeleton above = SkeletonFromTPose(origins, {});
  for (Vector3d& origin : origins) origin.z() -= 1.3;
  const Skeleton below = SkeletonFromTPose(origins, {});
  for (const Skeleton& skeleton : {above, below}) {
    EXPECT_NEAR(skeleton.heel_in_foot[kLeft].z(), -0.080 * 1.8 / kReferenceHeight, 0.003);
    EXPECT_NEAR(skeleton.height, 1.8, 0.01);
  }
}

// joint-loads.md 1.6, as fractions of the stature that the rest of the body leads to.
TEST(Skeleton, UsesFractionsOfTheStatureBesideBonesOfNoHumanLength) {
  auto origins = TPoseOrigins(DefaultSkeleton(1.8));
  for (const int segment : {kRightHand, kLeftHand}) {
    origins[At(segment)] = origins[At(segment - 1)];  // no forearm
  }
  origins[kHead] = origins[kNeck];
  for (const int segment : {kRightToe, kLeftToe}) origins[At(segment)] = origins[At(segment - 1)];
  for (Vector3d& origin : origins) origin.z() += 5;
  const Skeleton skeleton = SkeletonFromTPose(origins, {});
  const double h = skeleton.height;
  EXPECT_NEAR(skeleton.head_top_in_head.z() / h, 0.108, 1e-9);
  for (const Side side : {kRight, kLeft}) {
    EXPECT_NEAR(skeleton.finger_tip_in_hand[side].z() / h, -0.108, 1e-9);
    EXPECT_NEAR(skeleton.heel_in_foot[side].x() / h, -0.026, 1e-9);
    EXPECT_NEAR(skeleton.heel_in_foot[side].z() / h, -0.046, 1e-9);
    EXPECT_NEAR(skeleton.toe_tip_in_toe[side].x() / h, 0.04, 1e-9);
    const int toe = side == kRight ? kRightToe : kLeftToe;
    const double sole = skeleton.origin_in_parent[At(toe)].z() + skeleton.toe_tip_in_toe[side].z();
    EXPECT_LE(sole, skeleton.heel_in_foot[side].z() + 1e-9) << "the toe ends above the sole";
  }
}

TEST(Skeleton, NamesTheJointThatIsMissingFromTheLandmarks) {
  try {
    SkeletonFromLandmarks({});
    FAIL() << "accepted a body without joints";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "segment Pelvis has no point 'jL5S1'");
  }
}

}  // namespace
}  // namespace kinescope::urdf
