/// Converts messages about forces for server/loads, or returns why they are rejected. Pure: no
/// node, no clock; any thread. World is the reference frame; metres, newtons, N·m. Input is
/// untrusted: forces beyond human range are rejected.
#pragma once

#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <kinescope/JointLoadArray.h>
#include <sensor_msgs/JointState.h>

#include <array>
#include <string>

#include "core/force_inputs.h"
#include "server/ros/force_frames.h"
#include "server/ros/refusal.h"

namespace kinescope::ros_bridge {

/// Ground reaction force on a foot or on the person; moments are about the origin of the frame, as
/// in sensors and force plates. The CoP is where its line of action meets the floor, less than 2 m
/// from the pelvis. A force without horizontal part counts as that of a one-axis plate. Below 20 N
/// the values of a plate are noise: no force.
Taken<MeasuredGroundForce> ToGroundForce(const geometry_msgs::WrenchStamped& message,
                                         const FoundFrame& frame, const BodyNow& body);

/// A measured CoP, projected vertically to the floor.
Taken<Eigen::Vector3d> ToCop(const geometry_msgs::PointStamped& message, const FoundFrame& frame,
                             const BodyNow& body);

/// External force on a hand. In a link frame or the reference frame it acts at the grip point;
/// otherwise at the origin of the frame, less than 2 m from the hand.
Taken<MeasuredHandForce> ToHandForce(const geometry_msgs::WrenchStamped& message,
                                     const FoundFrame& frame, urdf::Side side, const BodyNow& body);

/// External joint loads. `scale` multiplies moments: -1 for a program that means the moment that
/// the child exerts on the parent. Unknown joints are counted in `unknown_joints`.
struct ExternalLoads {
  std::array<ExternalJointLoad, urdf::kJointCount> joints;  // stamp_nanos: set by the caller
  std::array<bool, urdf::kJointCount> is_given{};
  int unknown_joints = 0;
};
Taken<ExternalLoads> ToExternalLoads(const kinescope_ros::JointLoadArray& message,
                                     const FoundFrame& frame, double scale);

/// `effort`: moments about each joint's own axes (Kinescope: y, then x, then z; with names in
/// _rotx: x, y, z on T-pose frames, as in human-gazebo's URDFs); an axis without a name has none.
/// Without efforts, and with names without an axis, `position` is the ratio.
Taken<ExternalLoads> ToExternalLoads(const sensor_msgs::JointState& message, const BodyNow& body,
                                     double scale);

}  // namespace kinescope::ros_bridge
