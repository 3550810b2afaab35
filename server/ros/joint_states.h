/// Converts PersonState to sensor_msgs/JointState. Pure: no node, no clock, no master; any thread.
#pragma once

#include <sensor_msgs/JointState.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

#include "core/scene_state.h"
#include "server/ros/names.h"

namespace kinescope::ros_bridge {

/// Positions computed from the poses, rad (m for a prop's prismatic joints). Velocities, rad/s, if
/// angular rates were measured, else empty. Efforts, N·m: the moment computed by Kinescope's
/// inverse dynamics about the axis of each joint in the URDF chain (the axis after the rotations
/// before it, so that effort times velocity is power); NaN where unknown; empty if all are unknown.
/// Fingers and props have neither velocity nor effort: NaN.
/// @pre `names` are those of person.model->human
void FillComputedJointStates(const PersonState& person, const PersonNames& names,
                             sensor_msgs::JointState& message);

/// Positions only, from the streamed angles with the mapping of xsens_mvn_ros. MVN sends none for
/// fingers and props; their positions are computed. Returns false and does not change `message` if
/// the sample has no streamed angles.
[[nodiscard]] bool FillStreamedJointStates(const PersonState& person, const PersonNames& names,
                                           sensor_msgs::JointState& message);

/// MVN's (x, y, z), degrees -> those of xsens_mvn_ros (x, y, z), rad.
Eigen::Vector3d SeedAngles(int joint, const Eigen::Vector3d& streamed_deg);

/// d/dt of (x, y, z), rad/s, if the child rotates with `rate` relative to its parent (rad/s,
/// parent's axes) and R_parent_child = Ry(y) Rx(x) Rz(z). At |x| = 90 deg only the sum of y and z
/// is determined; then the smallest rates that give the motion.
Eigen::Vector3d AngleRates(const Eigen::Vector3d& angles, const Eigen::Vector3d& rate);

/// `moment` about the axes of the joint's x, y and z in the URDF chain; all in world axes, N·m.
Eigen::Vector3d AxisMoments(const Eigen::Quaterniond& world_from_parent,
                            const Eigen::Quaterniond& world_from_child, double y,
                            const Eigen::Vector3d& moment);

}  // namespace kinescope::ros_bridge
