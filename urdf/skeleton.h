/// How long one person's segments are: joint offsets and end points. Metres; every vector is in the
/// *link* frame named (N-pose aligned: x forward, y left, z up with arms hanging).
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <string>
#include <utility>

#include "urdf/segments.h"

namespace kinescope::urdf {

enum Side : int { kRight = 0, kLeft = 1 };

constexpr int HandSegmentOf(Side side) { return side == kRight ? kRightHand : kLeftHand; }
constexpr int FootSegmentOf(Side side) { return side == kRight ? kRightFoot : kLeftFoot; }

struct Skeleton {
  /// Origin of each segment in its parent's link frame; zero for the pelvis.
  std::array<Eigen::Vector3d, kSegmentCount> origin_in_parent{};

  // Where segments without a child end. Two-element arrays are indexed by `Side`.
  Eigen::Vector3d head_top_in_head = Eigen::Vector3d::Zero();
  std::array<Eigen::Vector3d, 2> finger_tip_in_hand{};
  std::array<Eigen::Vector3d, 2> heel_in_foot{};
  std::array<Eigen::Vector3d, 2> toe_tip_in_toe{};

  double height = 0;  // stature

  bool operator==(const Skeleton& other) const;
};

/// The default body, of `height_m` metres: the reference skeleton R75 (joint-loads.md 6.1, stature
/// 1.750 m), scaled in proportion.
/// @pre 0.5 <= height_m <= 2.5
Skeleton DefaultSkeleton(double height_m = 1.75);

/// Landmarks by (segment, name), such as {kHead, "pTopOfHead"}: offset from the segment's origin in
/// the *segment* frame (as type 13 and MVNX give them).
using Landmarks = std::map<std::pair<int, std::string>, Eigen::Vector3d>;

/// The skeleton of MVN's scale data: segment origins in the T-pose (world axes; every segment frame
/// is identity there) and whatever landmarks came with them. Joints are where the landmarks have
/// them (jL5S1 of the pelvis), as in MVNX, else where the T-pose has the next segment. End points
/// that are missing follow the stature fractions of joint-loads.md 1.6; the sole, where it is
/// missing, is the floor (z = 0) that the T-pose stands on, if that leaves an ankle as high as a
/// human's.
Skeleton SkeletonFromTPose(const std::array<Eigen::Vector3d, kSegmentCount>& origin_in_world,
                           const Landmarks& landmarks);

/// The skeleton of MVNX points, which contain the joints themselves (jL4L3 in L5, ...).
/// @throws std::runtime_error naming the joint that is missing.
Skeleton SkeletonFromLandmarks(const Landmarks& landmarks);

/// Origin of every link in the N-pose, pelvis at the height at which the lower sole touches z = 0.
std::array<Eigen::Vector3d, kSegmentCount> NPoseOrigins(const Skeleton& skeleton);

/// Where the segment ends, in its own link frame: its child's origin along the chain (T8: jT1C7,
/// pelvis: jL5S1, foot: ball), or the end point of head, hand and toe.
Eigen::Vector3d EndOf(const Skeleton& skeleton, int segment);

/// Where a hand holds things, in its link frame: 0.42 of the hand's length from the wrist
/// (joint-loads.md 2.7).
Eigen::Vector3d GripPoint(const Skeleton& skeleton, Side side);

}  // namespace kinescope::urdf
