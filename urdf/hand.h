/// A gloved hand: the twenty segments that MVN streams for each, their lengths, angles and poses.
/// Frames: a finger's *link* frame is turned from its segment frame as its hand's is
/// (segments.h), so in the N-pose it is parallel to it: fingers point along -z, the thumb is at +x,
/// the palms face each other. Metres, radians. The chain of each joint is that of kinematics.h.
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

/// The parent of each of them as an index of kFingers; -1 for the carpus, whose parent is the hand.
extern const std::array<int, kFingersPerHand> kFingerParents;

struct HandSkeleton {
  /// Origin of each segment in its parent's link frame; of the carpus in the hand's.
  std::array<Eigen::Vector3d, kFingersPerHand> origin_in_parent{};
  double length = 0.19;  // wrist to tip of the middle finger
};

/// An average adult's hand, `length` long. The carpus is at the wrist.
HandSkeleton DefaultHand(Side side, double length);

/// From the segments' origins in the T-pose (world axes) and the carpus' in its hand's link frame.
HandSkeleton HandFromTPose(Side side,
                           const std::array<Eigen::Vector3d, kFingersPerHand>& origin_in_world,
                           const Eigen::Vector3d& carpus_in_hand, double length);

/// Where the segment ends, in its own link frame. A fingertip is as far on as is usual.
Eigen::Vector3d EndOf(const HandSkeleton& hand, int finger);

/// Which ray of the hand a segment other than the carpus belongs to: 0 the thumb, 4 the little
/// finger; and how many segments of the ray come before it: 0 the metacarpal. @pre finger > 0
int RayOf(int finger);
int PlaceInRay(int finger);
/// The first segment of a ray; those that follow it come next in kFingers.
int MetacarpalOf(int ray);
/// Whether the segment is the last of its ray.
bool IsFingertip(int finger);

/// What the joint between `finger` and its parent is like.
FingerJoint KindOf(int finger);

using FingerPoses = std::array<Pose, kFingersPerHand>;              // link frames, world
using FingerAngles = std::array<Eigen::Vector3d, kFingersPerHand>;  // (x, y, z) rad

/// The poses of all segments: those of `present` as `measured`, others where `angles` put them.
/// `angles`, normally the sample's before, becomes those of the measured pose.
FingerPoses CompleteHand(const HandSkeleton& skeleton, const Pose& world_from_hand,
                         const FingerPoses& measured, const std::bitset<kFingersPerHand>& present,
                         FingerAngles& angles);

}  // namespace kinescope::urdf
