#include "urdf/hand.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kinescope::urdf {
namespace {

using Eigen::Vector3d;

// Origins of an open hand in its hand's link frame.
std::array<Vector3d, kFingersPerHand> Origins(const HandSkeleton& hand) {
  std::array<Vector3d, kFingersPerHand> origins;
  for (std::size_t i = 0; i < origins.size(); ++i) {
    const int parent = kFingerParents[i];
    origins[i] = hand.origin_in_parent[i];
    if (parent >= 0) origins[i] += origins[At(parent)];
  }
  return origins;
}

int FindFinger(std::string_view name) {
  for (int i = 0; i < kFingersPerHand; ++i) {
    if (kFingers[At(i)] == name) return i;
  }
  ADD_FAILURE() << name;
  return 0;
}

TEST(Hand, HasTheRequestedLengthUpToTheMiddleFingertip) {
  for (const double length : {0.15, 0.21}) {
    const HandSkeleton hand = DefaultHand(kRight, length);
    const auto origins = Origins(hand);
    double farthest = 0;
    for (int i = 0; i < kFingersPerHand; ++i) {
      const Vector3d tip = origins[At(i)] + EndOf(hand, i);
      farthest = std::max(farthest, -tip.z());
    }
    const int third = FindFinger("ThirdDP");
    EXPECT_EQ(-(origins[At(third)] + EndOf(hand, third)).z(), farthest);
    EXPECT_NEAR(farthest, length, 0.03 * length);
  }
}

TEST(Hand, HasTheThumbInFrontAndFingersOfNaturalLengths) {
  const auto origins = Origins(DefaultHand(kLeft, 0.19));
  EXPECT_GT(origins[At(FindFinger("FirstPP"))].x(), 0.04) << "the thumb is in front";
  EXPECT_LT(origins[At(FindFinger("FifthPP"))].x(), 0);
  EXPECT_LT(origins[At(FindFinger("SecondPP"))].z(), origins[At(FindFinger("SecondMC"))].z());
  for (int i = 1; i < kFingersPerHand; ++i) {
    const double bone = DefaultHand(kLeft, 0.19).origin_in_parent[At(i)].norm();
    EXPECT_GT(bone, 0.01) << kFingers[At(i)];
    EXPECT_LT(bone, 0.1) << kFingers[At(i)];
  }
}

TEST(Hand, IsRestoredFromItsOwnTPose) {
  for (const Side side : {kRight, kLeft}) {
    const HandSkeleton hand = DefaultHand(side, 0.2);
    auto world = Origins(hand);
    for (Vector3d& origin : world) {  // every segment frame is the world's in the T-pose
      origin = Vector3d(0, 0.7, 1.4) + SegmentFromLink(HandSegmentOf(side)) * origin;
    }
    const HandSkeleton back = HandFromTPose(side, world, hand.origin_in_parent[0], 0.2);
    for (std::size_t i = 0; i < kFingersPerHand; ++i) {
      EXPECT_LT((back.origin_in_parent[i] - hand.origin_in_parent[i]).norm(), 1e-12);
    }
  }
}

TEST(Hand, HasAKindForEachOfItsJoints) {
  EXPECT_EQ(KindOf(FindFinger("Carpus")), FingerJoint::kCarpus);
  EXPECT_EQ(KindOf(FindFinger("FirstMC")), FingerJoint::kThumbBase);
  EXPECT_EQ(KindOf(FindFinger("FirstPP")), FingerJoint::kKnuckle);
  EXPECT_EQ(KindOf(FindFinger("FirstDP")), FingerJoint::kEnd);
  EXPECT_EQ(KindOf(FindFinger("FourthMC")), FingerJoint::kPalm);
  EXPECT_EQ(KindOf(FindFinger("FourthPP")), FingerJoint::kKnuckle);
  EXPECT_EQ(KindOf(FindFinger("FourthMP")), FingerJoint::kMiddle);
  EXPECT_EQ(KindOf(FindFinger("FifthDP")), FingerJoint::kEnd);
}

// The palms face each other in the N-pose, so the fingers close towards the body's middle.
TEST(Hand, BendsItsFingersTowardsThePalmWithinTheirLimits) {
  for (const Side side : {kRight, kLeft}) {
    for (const char* name : {"SecondPP", "ThirdMP", "FifthDP"}) {
      const AxisLimit x = LimitOf(KindOf(FindFinger(name)), side == kLeft, 0);
      const double far = std::abs(x.lower) > x.upper ? x.lower : x.upper;
      const Vector3d tip = RotationFromAngles({far, 0, 0}) * Vector3d(0, 0, -1);
      EXPECT_EQ(tip.y() > 0, side == kRight) << name;  // y is left
      EXPECT_GT(std::abs(far), 1.5) << name;
    }
  }
}

TEST(Hand, CompletesUnmeasuredFingersAndComputesTheAnglesOfMeasuredOnes) {
  const HandSkeleton hand = DefaultHand(kRight, 0.19);
  const Pose world_from_hand = {{1, 2, 3}, RotationFromAngles({0.3, -0.2, 0.9})};
  FingerAngles truth;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    truth[i] = {0.04 * static_cast<double>(i), 0.1, -0.02 * static_cast<double>(i)};
  }
  const FingerPoses whole = CompleteHand(hand, world_from_hand, {}, {}, truth);

  std::bitset<kFingersPerHand> present;
  present.set();
  present.reset(At(FindFinger("ThirdMP")));
  FingerAngles angles = truth;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    if (present.test(i)) angles[i].setZero();
  }
  FingerPoses measured = whole;
  measured[At(FindFinger("ThirdMP"))] = {};
  const FingerPoses again = CompleteHand(hand, world_from_hand, measured, present, angles);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_LT((again[i].position - whole[i].position).norm(), 1e-12) << kFingers[i];
    EXPECT_LT(again[i].orientation.angularDistance(whole[i].orientation), 1e-7) << kFingers[i];
    EXPECT_LT((angles[i] - truth[i]).norm(), 1e-9) << kFingers[i];
  }
}

TEST(Hand, NumbersItsRaysInTheirOrder) {
  for (int ray = 0; ray < 5; ++ray) {
    int finger = MetacarpalOf(ray);
    EXPECT_EQ(kFingerParents[At(finger)], 0) << ray;
    for (int place = 0; place < (ray == 0 ? 3 : 4); ++place, ++finger) {
      EXPECT_EQ(RayOf(finger), ray) << finger;
      EXPECT_EQ(PlaceInRay(finger), place) << finger;
      EXPECT_EQ(IsFingertip(finger),
                kFingers[At(finger)].substr(5) == "DP" || kFingers[At(finger)].substr(6) == "DP")
          << kFingers[At(finger)];
    }
  }
  EXPECT_FALSE(IsFingertip(0));
}

}  // namespace
}  // namespace kinescope::urdf
