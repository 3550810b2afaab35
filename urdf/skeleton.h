/// Segment lengths of one person: joint offsets and end points. Metres; every vector is in the
/// named *link* frame (N-pose aligned: x forward, y left, z up with arms hanging). Pure functions,
/// any thread.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "urdf/segments.h"

namespace kinescope::urdf {

enum Side : int { kRight = 0, kLeft = 1 };

constexpr int HandSegmentOf(Side side) { return side == kRight ? kRightHand : kLeftHand; }
constexpr int FootSegmentOf(Side side) { return side == kRight ? kRightFoot : kLeftFoot; }

struct Skeleton {
  /// Origin of each segment in its parent's link frame; zero for the pelvis.
  std::array<Eigen::Vector3d, kSegmentCount> origin_in_parent{};

  // End points of segments without a child. Two-element arrays are indexed by `Side`.
  Eigen::Vector3d head_top_in_head = Eigen::Vector3d::Zero();
  std::array<Eigen::Vector3d, 2> finger_tip_in_hand{};
  std::array<Eigen::Vector3d, 2> heel_in_foot{};
  std::array<Eigen::Vector3d, 2> toe_tip_in_toe{};

  double height = 0;                // stature, m
  bool ends_are_estimated = false;  // at least one of the end points was not measured

  bool operator==(const Skeleton& other) const;
};

/// Stature of the reference skeleton R75 (joint-loads.md 6.1), m. Bodies, motions and sizes in
/// pictures are made for it, and scaled in proportion for other statures.
inline constexpr double kReferenceHeight = 1.75;

/// Stature of a person whose segment lengths and stature are unknown, m.
inline constexpr double kDefaultHeight = kReferenceHeight;

/// The default body with a stature of `height_m` metres: the reference skeleton, scaled.
/// @pre 0.5 <= height_m <= 2.5
Skeleton DefaultSkeleton(double height_m = kDefaultHeight);

struct Landmark;  // urdf/landmarks.h
/// As the source has them, in its order.
using Landmarks = std::vector<Landmark>;

/// The skeleton from MVN's scale data: segment origins in the T-pose (world axes, m; every segment
/// frame is identity there) and the landmarks that came with them. A joint is at its landmark
/// (jL5S1 of the pelvis), as in MVNX, else at the origin of the next segment in the T-pose. A
/// missing sole is the floor of the T-pose (z = 0), if the ankle then has a human height. Other
/// missing end points are in proportion to the bone beside them, as in MVN's own skeletons (the
/// head to the neck, the hand to the forearm, heel and toe to the foot); where that bone has no
/// human length, to the stature (joint-loads.md 1.6).
Skeleton SkeletonFromTPose(const std::array<Eigen::Vector3d, kSegmentCount>& origin_in_world,
                           const Landmarks& landmarks);

/// The skeleton from MVNX points, which contain the joints themselves (jL4L3 in L5, ...).
/// @throws std::runtime_error with the missing joint.
Skeleton SkeletonFromLandmarks(const Landmarks& landmarks);

/// World position of the origin of every link in the N-pose, m; the lower sole touches z = 0.
std::array<Eigen::Vector3d, kSegmentCount> NPoseOrigins(const Skeleton& skeleton);

/// End point of the segment in its own link frame, m: the origin of its child along the chain (T8:
/// jT1C7, pelvis: jL5S1, foot: ball), or the end point of head, hand or toe.
Eigen::Vector3d EndOf(const Skeleton& skeleton, int segment);

/// Grip point of a hand in its link frame, m: 0.42 of the hand's length from the wrist
/// (joint-loads.md 2.7).
Eigen::Vector3d GripPoint(const Skeleton& skeleton, Side side);

}  // namespace kinescope::urdf
