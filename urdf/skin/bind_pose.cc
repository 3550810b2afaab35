#include "urdf/skin/bind_pose.h"

#include <cmath>

namespace kinescope::skin {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180;
constexpr double kArmsOut = 42 * kDegree, kLegsOut = 9 * kDegree;

// Towards the palm, rad; a relaxed hand.
constexpr double kKnuckleBend = 0.16, kMiddleBend = 0.26, kEndBend = 0.20;
// The fingers lie closer together, and the thumb closer to them, than rays through the metacarpals.
constexpr std::array<double, 5> kTogether = {0.30, 0.075, 0.035, -0.06, -0.10};
constexpr double kThumbToPalm = 0.32;

urdf::FingerAngles BindAngles(urdf::Side side) {
  const double left = side == urdf::kLeft ? 1 : -1;
  urdf::FingerAngles angles{};
  for (int finger = 1; finger < urdf::kFingersPerHand; ++finger) {
    const int ray = urdf::RayOf(finger), place = urdf::PlaceInRay(finger);
    Vector3d& angle = angles[urdf::At(finger)];
    if (ray == 0) {
      if (place == 0) angle = {-left * kThumbToPalm, kTogether[0], 0};
      continue;
    }
    if (place == 0) continue;
    constexpr std::array<double, 3> kBends = {kKnuckleBend, kMiddleBend, kEndBend};
    angle.x() = -left * kBends[urdf::At(place - 1)];
    if (place == 1) angle.y() = kTogether[urdf::At(ray)];
  }
  return angles;
}

}  // namespace

BindPose BindPoseOf(const urdf::Skeleton& skeleton,
                    const std::array<const urdf::HandSkeleton*, 2>& hands) {
  urdf::JointAngles angles{};
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    const double left = side == urdf::kLeft ? 1 : -1;
    const auto set = [&](int right_joint, int left_joint, double x) {
      angles[urdf::At(side == urdf::kLeft ? left_joint : right_joint)].x() = left * x;
    };
    set(urdf::jRightShoulder, urdf::jLeftShoulder, kArmsOut);
    set(urdf::jRightHip, urdf::jLeftHip, kLegsOut);
    set(urdf::jRightAnkle, urdf::jLeftAnkle, -kLegsOut);
  }
  BindPose pose;
  pose.links = urdf::ForwardKinematics(skeleton, {}, angles);
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    const int hand = urdf::HandSegmentOf(side);
    const urdf::HandSkeleton average = urdf::DefaultHand(side, urdf::EndOf(skeleton, hand).norm());
    const urdf::HandSkeleton& own = hands[side] == nullptr ? average : *hands[side];
    urdf::FingerAngles bend = BindAngles(side);
    pose.fingers[side] = urdf::CompleteHand(own, pose.links[urdf::At(hand)], {}, {}, bend);
  }
  return pose;
}

}  // namespace kinescope::skin
