/// Kinematics of a gloved hand: the twenty segments that MVN streams per hand, with lengths, angles
/// and poses. Frames: the rotation between *link* and segment frame of a finger is that of its hand
/// (segments.h), so in the N-pose the fingers point along -z, the thumb is at +x, the palms face
/// each other. Metres, radians. The chain of each joint is that of kinematics.h. Pure functions,
/// any thread.
#pragma once

#include <Eigen/Core>
#include <array>
#include <bitset>
#include <string_view>

#include "urdf/joint_limits.h"
#include "urdf/kinematics.h"
#include "urdf/skeleton.h"

namespace kinescope::urdf {

inline constexpr int kFingersPerHand = 20;

/// The segments of one hand in the order of the stream (mvn-protocol.md 4.2), without the side:
/// "Carpus", "FirstMC", ..., "FifthDP".
extern const std::array<std::string_view, kFingersPerHand> kFingers;

/// The parent of each segment as an index of kFingers; -1 for the carpus, whose parent is the hand.
extern const std::array<int, kFingersPerHand> kFingerParents;

struct HandSkeleton {
  /// Origin of each segment in its parent's link frame, m; that of the carpus in the hand's link
  /// frame.
  std::array<Eigen::Vector3d, kFingersPerHand> origin_in_parent{};
  double length = 0.19;  // wrist to tip of the middle finger, m
};

/// The hand of an average adult, scaled to `length`, m. The carpus is at the wrist.
HandSkeleton DefaultHand(Side side, double length);

/// A hand from the origins of its segments in the T-pose (world axes, m) and the origin of the
/// carpus in the hand's link frame.
HandSkeleton HandFromTPose(Side side,
                           const std::array<Eigen::Vector3d, kFingersPerHand>& origin_in_world,
                           const Eigen::Vector3d& carpus_in_hand, double length);

/// End point of the segment, in its own link frame, m. Fingertips have average lengths.
Eigen::Vector3d EndOf(const HandSkeleton& hand, int finger);

/// RayOf: the ray of the hand that a segment belongs to, from 0 (thumb) to 4 (little finger).
/// PlaceInRay: the number of segments of the ray before it, 0 for the metacarpal. @pre finger > 0
int RayOf(int finger);
int PlaceInRay(int finger);
/// The first segment of a ray; the others of the ray follow it in kFingers.
int MetacarpalOf(int ray);
/// Whether the segment is the last of its ray.
bool IsFingertip(int finger);

/// The type of the joint between `finger` and its parent.
FingerJoint KindOf(int finger);

using FingerPoses = std::array<Pose, kFingersPerHand>;              // world_from_link
using FingerAngles = std::array<Eigen::Vector3d, kFingersPerHand>;  // (x, y, z) rad

/// The poses of all segments: measured poses for those in `present`; the others are placed by
/// `angles`. Pass the angles of the previous sample; they are replaced by those of the returned
/// poses.
FingerPoses CompleteHand(const HandSkeleton& skeleton, const Pose& world_from_hand,
                         const FingerPoses& measured, const std::bitset<kFingersPerHand>& present,
                         FingerAngles& angles);

}  // namespace kinescope::urdf
