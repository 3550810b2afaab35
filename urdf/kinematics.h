/// Computes poses, joint angles and forward kinematics of the human, with the joint chain of the
/// URDF. Pure functions, any thread.
///
/// Every joint of the URDF rotates about y, then x, then z:
///     R_parent_child = Ry(y) * Rx(x) * Rz(z)          (link frames)
/// Only with this order are the angles that xsens_mvn_ros publishes right (mvn-protocol.md 6.1).
/// Angles are in radians, stored as (x, y, z). Positions are in metres.
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "urdf/skeleton.h"

namespace kinescope::urdf {

struct Pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();               // world, m
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // world_from_(link or segment)
};

using LinkPoses = std::array<Pose, kSegmentCount>;             // link frames
using JointAngles = std::array<Eigen::Vector3d, kJointCount>;  // (x, y, z) rad

/// from_from_to: the pose of `to` relative to `from`. Both are given in one frame.
[[nodiscard]] Pose Relative(const Pose& from, const Pose& to);

/// Ry(y) * Rx(x) * Rz(z).
Eigen::Quaterniond RotationFromAngles(const Eigen::Vector3d& xyz);

/// Within this distance of |x| = 90 deg, rad, y and z rotate about the same axis. The last bits of
/// the orientations would then decide how the rotation is divided between them: MVN streams 24
/// bits, which leaves up to 3e-7 rad in the rotation between two segments.
constexpr double kGimbalLock = 4e-7;

/// Inverse of RotationFromAngles. Of all triples for the same rotation, returns the one nearest to
/// `near`. So angles neither jump by 2 pi nor to the other solution (180 deg - x, y + 180 deg, z +
/// 180 deg) when x passes 90 deg. Within kGimbalLock of 90 deg, x becomes 90 deg, y is that of
/// `near` and z takes the rest; this rotates the result by at most kGimbalLock. A motion that
/// passes close to 90 deg without reaching it really rotates y and z by half a turn; no choice of
/// solution can avoid that.
Eigen::Vector3d AnglesFromRotation(const Eigen::Quaterniond& parent_from_child,
                                   const Eigen::Vector3d& near = Eigen::Vector3d::Zero());

/// Angles of all joints of a posed human. `near` as above, normally the angles of the previous
/// sample.
JointAngles AnglesFromPoses(const LinkPoses& poses, const JointAngles& near);

/// World poses of all links of the rigid URDF human: the skeleton with its pelvis at `pelvis`, bent
/// by `angles`.
LinkPoses ForwardKinematics(const Skeleton& skeleton, const Pose& pelvis,
                            const JointAngles& angles);

/// Heel and tip of the toe on the sole of one foot.
std::array<Eigen::Vector3d, 2> SolePoints(const Skeleton& skeleton, const LinkPoses& links,
                                          Side side);

/// Height of the lowest of these points of both feet, m.
double LowestSolePoint(const Skeleton& skeleton, const LinkPoses& links);

/// Between `a` and `b`: positions linear, orientations slerp along the shorter arc. t in [0, 1].
[[nodiscard]] Pose Interpolate(const Pose& a, const Pose& b, double t);
[[nodiscard]] LinkPoses Interpolate(const LinkPoses& a, const LinkPoses& b, double t);

}  // namespace kinescope::urdf
