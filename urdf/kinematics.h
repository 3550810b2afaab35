/// Poses, joint angles and forward kinematics of the human as our URDF chains it.
///
/// The URDF turns about y, then x, then z at every joint:
///     R_parent_child = Ry(y) * Rx(x) * Rz(z)          (link frames)
/// This is the only order under which the angles that the seed bridge publishes are right
/// (mvn-protocol.md 6.1). Angles are radians, stored as (x, y, z).
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "urdf/skeleton.h"

namespace kinescope::urdf {

struct Pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();               // in the world, m
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // world_from_(link or segment)
};

using LinkPoses = std::array<Pose, kSegmentCount>;             // link frames
using JointAngles = std::array<Eigen::Vector3d, kJointCount>;  // (x, y, z) rad

/// from_from_to: where `to` stands as `from` sees it. Both in one frame.
[[nodiscard]] Pose Relative(const Pose& from, const Pose& to);

/// Ry(y) * Rx(x) * Rz(z).
Eigen::Quaterniond RotationFromAngles(const Eigen::Vector3d& xyz);

/// This near to |x| = 90 deg, rad, y and z turn about one axis. How the turn is shared between them
/// would be read from the last bits of the orientations: MVN streams them with 24 bits, which
/// leaves up to 3e-7 rad in the turn between two segments.
constexpr double kGimbalLock = 4e-7;

/// Inverse of RotationFromAngles. Of all triples that mean the same rotation, the one nearest to
/// `near` is taken, so angles neither jump by 2 pi nor onto the other solution (180 deg - x,
/// y + 180 deg, z + 180 deg) when x passes 90 deg. Within kGimbalLock of it x becomes 90 deg, y
/// stays what it was and z takes the rest: that turns the result by kGimbalLock at most. A motion
/// that passes close by without touching it truly turns y and z by half a turn; no choice of
/// solution can avoid that.
Eigen::Vector3d AnglesFromRotation(const Eigen::Quaterniond& parent_from_child,
                                   const Eigen::Vector3d& near = Eigen::Vector3d::Zero());

/// Angles of all joints of a posed human; `near` as above, normally the previous sample's angles.
JointAngles AnglesFromPoses(const LinkPoses& poses, const JointAngles& near);

/// Every link of the rigid URDF human: the skeleton, hung at `pelvis`, bent by `angles`.
LinkPoses ForwardKinematics(const Skeleton& skeleton, const Pose& pelvis,
                            const JointAngles& angles);

/// Between `a` and `b`: positions linear, orientations slerp along the shorter arc. t in [0, 1].
[[nodiscard]] Pose Interpolate(const Pose& a, const Pose& b, double t);
[[nodiscard]] LinkPoses Interpolate(const LinkPoses& a, const LinkPoses& b, double t);

}  // namespace kinescope::urdf
