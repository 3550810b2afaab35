/// PersonState -> sensor_msgs/JointState. Pure: no node, no clock, no master.
#pragma once

#include <sensor_msgs/JointState.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

#include "core/scene_state.h"
#include "server/ros/names.h"

namespace kinescope::ros_bridge {

/// Positions from the poses, rad (m where a prop slides). Velocities, rad/s, where angular rates
/// were measured, else empty. Efforts, N m, are the moment that our own inverse dynamics
/// finds about the axis of each joint as the URDF chains them (the axis after the turns before it,
/// so that effort times velocity is power), NaN where it is not known; empty when none is. Fingers
/// and props have neither: NaN.
/// @pre `names` are those of person.model->human
void FillComputedJointStates(const PersonState& person, const PersonNames& names,
                             sensor_msgs::JointState& message);

/// Positions alone, from the streamed angles, as the seed bridge maps them; MVN sends none of
/// fingers and props, whose positions are computed. False, and `message` as it was, when the sample
/// carries none.
[[nodiscard]] bool FillStreamedJointStates(const PersonState& person, const PersonNames& names,
                                           sensor_msgs::JointState& message);

/// MVN's (x, y, z), degrees -> the seed's (x, y, z), rad.
Eigen::Vector3d SeedAngles(int joint, const Eigen::Vector3d& streamed_deg);

/// d/dt of (x, y, z) when the child turns with `rate` against its parent (rad/s, parent's axes) and
/// R_parent_child = Ry(y) Rx(x) Rz(z). Where |x| = 90 deg leaves only the sum of y and z
/// determined, the smallest rates that give the motion.
Eigen::Vector3d AngleRates(const Eigen::Vector3d& angles, const Eigen::Vector3d& rate);

/// `moment` about the axes of joint's x, y and z as the URDF chains them; all in world axes.
Eigen::Vector3d AxisMoments(const Eigen::Quaterniond& world_from_parent,
                            const Eigen::Quaterniond& world_from_child, double y,
                            const Eigen::Vector3d& moment);

}  // namespace kinescope::ros_bridge
