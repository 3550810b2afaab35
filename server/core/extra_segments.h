/// What moves with a body beyond its 23 segments: gloves and props. Poses of segment frames, as in
/// body_sample.h. Plain data.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "urdf/kinematics.h"
#include "urdf/skeleton.h"

namespace kinescope {

inline constexpr int kMostProps = 4;
inline constexpr int kFingersPerHand = 20;  // see kFingers
inline constexpr int kExtraCount = kMostProps + 2 * kFingersPerHand;

/// The segments of one hand in the order of the stream (mvn-protocol.md 4.2), without the side:
/// "Carpus", "FirstMC", ..., "FifthDP".
extern const std::array<std::string_view, kFingersPerHand> kFingers;

/// The parent of each of them as an index of kFingers; -1 for the carpus, whose parent is the hand.
extern const std::array<int, kFingersPerHand> kFingerParents;

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
