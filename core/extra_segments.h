/// What moves with a body beyond its 23 segments: gloves and props. Poses of segment frames, as in
/// body_sample.h. Plain data.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "urdf/hand.h"
#include "urdf/human_urdf.h"
#include "urdf/kinematics.h"
#include "urdf/skeleton.h"

namespace kinescope {

using urdf::kFingerParents;
using urdf::kFingers;
using urdf::kFingersPerHand;
using urdf::kMostProps;

inline constexpr int kExtraCount = kMostProps + 2 * kFingersPerHand;

/// Where a prop (0 to 3) or a finger's segment lies in ExtraSegments.
constexpr int PropIndex(int prop) { return prop; }
constexpr int FingerIndex(urdf::Side side, int finger) {
  return kMostProps + (side == urdf::kLeft ? 0 : kFingersPerHand) + finger;
}

struct ExtraSegments {
  std::array<urdf::Pose, kExtraCount> poses{};  // world_from_segment
  std::bitset<kExtraCount> present;
};

/// "Left" + kFingers for a finger, "Prop1" for a prop without a name of its own.
std::string ExtraName(int index);

}  // namespace kinescope
