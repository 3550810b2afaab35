#include "urdf/skin/limbs.h"

#include <bitset>
#include <initializer_list>
#include <utility>

namespace kinescope::skin {
namespace {

// Those that do not cover each other, because their surfaces go over into one another.
std::bitset<kLimbs> Merged(Limb limb) {
  std::bitset<kLimbs> merged;
  merged.set(limb);
  const auto with = [&](std::initializer_list<Limb> others) {
    for (const Limb other : others) merged.set(other);
  };
  switch (limb) {
    case kBellyLimb: with({kPelvisLimb, kChestLimb}); break;
    case kChestLimb: with({kPelvisLimb, kBellyLimb, kNeckLimb}); break;
    case kNeckLimb: with({kChestLimb, kHeadLimb}); break;
    case kHeadLimb: with({kNeckLimb}); break;
    case kRightHandLimb: with({kRightForeArmLimb}); break;
    case kLeftHandLimb: with({kLeftForeArmLimb}); break;
    case kRightFootLimb: with({kRightShankLimb}); break;
    case kLeftFootLimb: with({kLeftShankLimb}); break;
    default: break;
  }
  return merged;
}

bool IsTrunkOrThigh(Limb limb) {
  return limb <= kChestLimb || limb == kRightThighLimb || limb == kLeftThighLimb;
}

// Those that are joined: what lies on the one is skin of the other. Trunk and thighs all are: where
// they fold, the skin on both sides of a border between them must be as dark.
bool AreJoined(Limb a, Limb b) {
  if (IsTrunkOrThigh(a) && IsTrunkOrThigh(b)) return true;
  if (a > b) std::swap(a, b);
  if (b == kRightUpperArmLimb || b == kLeftUpperArmLimb) return a == kChestLimb;
  const bool is_thigh = b == kRightThighLimb || b == kLeftThighLimb;
  return !is_thigh && b == a + 1;
}

}  // namespace

Limb LimbOfSegment(int segment) {
  switch (segment) {
    case urdf::kPelvis: return kPelvisLimb;
    case urdf::kL5:
    case urdf::kL3: return kBellyLimb;
    case urdf::kNeck: return kNeckLimb;
    case urdf::kHead: return kHeadLimb;
    case urdf::kRightUpperArm: return kRightUpperArmLimb;
    case urdf::kRightForeArm: return kRightForeArmLimb;
    case urdf::kRightHand: return kRightHandLimb;
    case urdf::kLeftUpperArm: return kLeftUpperArmLimb;
    case urdf::kLeftForeArm: return kLeftForeArmLimb;
    case urdf::kLeftHand: return kLeftHandLimb;
    case urdf::kRightUpperLeg: return kRightThighLimb;
    case urdf::kRightLowerLeg: return kRightShankLimb;
    case urdf::kRightFoot:
    case urdf::kRightToe: return kRightFootLimb;
    case urdf::kLeftUpperLeg: return kLeftThighLimb;
    case urdf::kLeftLowerLeg: return kLeftShankLimb;
    case urdf::kLeftFoot:
    case urdf::kLeftToe: return kLeftFootLimb;
    default: return kChestLimb;  // T12, T8, shoulders
  }
}

Covering CoveringOf(Limb skin, Limb by) {
  if (Merged(skin).test(by)) return Covering::kNone;
  return AreJoined(skin, by) ? Covering::kJoined : Covering::kWhole;
}

LimbShapes LimbShapesOf(const urdf::Skeleton& skeleton, const Build& build) {
  const double size = skeleton.height > 0 ? skeleton.height / urdf::kReferenceHeight : 1;
  const double more = 1 + 0.16 * build.heavy;
  const auto at = [&](int segment, double radius,
                      const Eigen::Vector3d& point = Eigen::Vector3d::Zero()) {
    return LimbEnd{segment, point, size * more * radius};
  };
  const auto end_of = [&](int segment, double radius) {
    return at(segment, radius, urdf::EndOf(skeleton, segment));
  };
  const auto along = [&](int segment, double start_radius, double end_radius) {
    return LimbShape{at(segment, start_radius), end_of(segment, end_radius)};
  };
  LimbShapes all;
  all[kPelvisLimb] = {at(urdf::kPelvis, 0.130), at(urdf::kL5, 0.120)};
  all[kBellyLimb] = {at(urdf::kL5, 0.115), at(urdf::kT12, 0.115)};
  const Eigen::Vector3d chest_end = 0.6 * skeleton.origin_in_parent[urdf::kNeck];
  all[kChestLimb] = {at(urdf::kT12, 0.125), at(urdf::kT8, 0.110, chest_end)};
  all[kNeckLimb] = along(urdf::kNeck, 0.055, 0.052);
  const double head_length = skeleton.head_top_in_head.norm();
  const auto in_head = [&](double x, double z, double radius) {
    return at(urdf::kHead, radius, Eigen::Vector3d(x, 0, z) * head_length);
  };
  all[kHeadLimb] = {in_head(0.10, 0.15, 0.062), in_head(0, 0.55, 0.082)};
  for (const bool is_left : {false, true}) {
    const int hand = is_left ? urdf::kLeftHand : urdf::kRightHand;
    const int foot = is_left ? urdf::kLeftFoot : urdf::kRightFoot;
    const auto arm = static_cast<std::size_t>(is_left ? kLeftUpperArmLimb : kRightUpperArmLimb);
    const auto leg = static_cast<std::size_t>(is_left ? kLeftThighLimb : kRightThighLimb);
    all[arm] = along(hand - 2, 0.050, 0.040);
    all[arm + 1] = along(hand - 1, 0.040, 0.028);
    all[arm + 2] = along(hand, 0.030, 0.022);
    all[leg] = along(foot - 2, 0.085, 0.058);
    all[leg + 1] = along(foot - 1, 0.055, 0.036);
    const Eigen::Vector3d below_ankle = Eigen::Vector3d(-0.02, 0, -0.045) * size;
    all[leg + 2] = {at(foot, 0.034, below_ankle), end_of(foot + 1, 0.020)};
  }
  return all;
}

}  // namespace kinescope::skin
