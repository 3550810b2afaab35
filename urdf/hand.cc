#include "urdf/hand.h"

namespace kinescope::urdf {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// One ray of the hand: thumb to little finger, in lengths of the hand, of an average adult.
// `forward` towards the thumb, `down` along the fingers.
struct Ray {
  double base_forward, base_down;        // where the metacarpal begins
  double knuckle_forward, knuckle_down;  // where it ends
  std::array<double, 2> phalanges;       // all but the last, which ends in nothing
};
constexpr std::array<Ray, 5> kRays = {{
    {0.11, 0.08, 0.27, 0.28, {0.18, 0.0}},
    {0.07, 0.12, 0.13, 0.49, {0.22, 0.13}},
    {0.02, 0.13, 0.03, 0.50, {0.25, 0.15}},
    {-0.03, 0.12, -0.06, 0.47, {0.23, 0.14}},
    {-0.07, 0.11, -0.14, 0.42, {0.18, 0.10}},
}};
constexpr double kTip = 0.75;  // length of a last phalanx, in those of the one before

bool IsThumb(int finger) { return finger >= 1 && finger <= 3; }

}  // namespace

const std::array<std::string_view, kFingersPerHand> kFingers = {
    "Carpus",   "FirstMC",  "FirstPP", "FirstDP", "SecondMC", "SecondPP", "SecondMP",
    "SecondDP", "ThirdMC",  "ThirdPP", "ThirdMP", "ThirdDP",  "FourthMC", "FourthPP",
    "FourthMP", "FourthDP", "FifthMC", "FifthPP", "FifthMP",  "FifthDP"};

const std::array<int, kFingersPerHand> kFingerParents = {-1, 0,  1, 2,  0,  4,  5, 6,  0,  8,
                                                         9,  10, 0, 12, 13, 14, 0, 16, 17, 18};

// Metacarpals begin a ray at 1 (thumb), 4, 8, 12 and 16.
int RayOf(int finger) { return finger / 4; }
int PlaceInRay(int finger) { return IsThumb(finger) ? finger - 1 : finger % 4; }
int MetacarpalOf(int ray) { return ray == 0 ? 1 : 4 * ray; }

bool IsFingertip(int finger) {
  return finger != 0 && PlaceInRay(finger) == (IsThumb(finger) ? 2 : 3);
}

HandSkeleton DefaultHand(Side, double length) {  // in the sagittal plane: both sides alike
  HandSkeleton hand;
  hand.length = length;
  std::size_t next = 1;
  for (const Ray& ray : kRays) {
    const Vector3d base(ray.base_forward, 0, -ray.base_down);
    const Vector3d bone = Vector3d(ray.knuckle_forward, 0, -ray.knuckle_down) - base;
    hand.origin_in_parent[next++] = length * base;
    hand.origin_in_parent[next++] = length * bone;
    for (const double phalanx : ray.phalanges) {
      if (phalanx > 0) hand.origin_in_parent[next++] = length * phalanx * bone.normalized();
    }
  }
  return hand;
}

HandSkeleton HandFromTPose(Side side, const std::array<Vector3d, kFingersPerHand>& origin_in_world,
                           const Vector3d& carpus_in_hand, double length) {
  HandSkeleton hand;
  hand.length = length;
  hand.origin_in_parent[0] = carpus_in_hand;
  const Quaterniond link_from_segment = SegmentFromLink(HandSegmentOf(side)).conjugate();
  for (std::size_t i = 1; i < origin_in_world.size(); ++i) {
    hand.origin_in_parent[i] =
        link_from_segment * (origin_in_world[i] - origin_in_world[At(kFingerParents[i])]);
  }
  return hand;
}

Vector3d EndOf(const HandSkeleton& hand, int finger) {
  if (finger == 0) return hand.origin_in_parent[8];  // towards the middle finger
  if (!IsFingertip(finger)) return hand.origin_in_parent[At(finger) + 1];
  return kTip * hand.origin_in_parent[At(finger)];
}

FingerJoint KindOf(int finger) {
  if (finger == 0) return FingerJoint::kCarpus;
  const int place = PlaceInRay(finger);
  if (place == 0) return IsThumb(finger) ? FingerJoint::kThumbBase : FingerJoint::kPalm;
  if (place == 1) return FingerJoint::kKnuckle;
  return IsFingertip(finger) ? FingerJoint::kEnd : FingerJoint::kMiddle;
}

FingerPoses CompleteHand(const HandSkeleton& skeleton, const Pose& world_from_hand,
                         const FingerPoses& measured, const std::bitset<kFingersPerHand>& present,
                         FingerAngles& angles) {
  FingerPoses poses;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose& parent = kFingerParents[i] < 0 ? world_from_hand : poses[At(kFingerParents[i])];
    if (present.test(i)) {
      poses[i] = measured[i];
      angles[i] =
          AnglesFromRotation(parent.orientation.conjugate() * poses[i].orientation, angles[i]);
    } else {
      poses[i] = {parent.position + parent.orientation * skeleton.origin_in_parent[i],
                  (parent.orientation * RotationFromAngles(angles[i])).normalized()};
    }
  }
  return poses;
}

}  // namespace kinescope::urdf
