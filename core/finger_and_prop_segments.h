/// Poses of the segments beyond the body's 23: gloves and props. Segment frames, as in
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
using urdf::kMaxProps;

inline constexpr int kFingerAndPropCount = kMaxProps + 2 * kFingersPerHand;

/// Index of a prop (0 to 3) or of a finger segment in FingerAndPropSegments.
constexpr int PropIndex(int prop) { return prop; }
constexpr int FingerIndex(urdf::Side side, int finger) {
  return kMaxProps + (side == urdf::kLeft ? 0 : kFingersPerHand) + finger;
}

struct FingerAndPropSegments {
  std::array<urdf::Pose, kFingerAndPropCount> poses{};  // world_from_segment
  std::bitset<kFingerAndPropCount> present;
};

/// "Left" or "Right" + kFingers for a finger, "Prop1" for a prop without a name.
std::string FingerOrPropName(int index);

}  // namespace kinescope
