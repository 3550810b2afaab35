/// Messages about forces -> what server/loads takes, or why not. Pure: no node, no clock. World is
/// the reference frame. All of it comes from strangers: nothing is believed that no person can
/// feel.
#pragma once

#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <kinescope/JointLoadArray.h>
#include <sensor_msgs/JointState.h>

#include <array>
#include <string>
#include <tl/expected.hpp>

#include "core/force_inputs.h"
#include "server/ros/force_frames.h"

namespace kinescope::ros_bridge {

struct Refusal {
  const char* kind;  // one of a fixed set: counted by it
  std::string text;  // one line with the values
};
template <class T>
using Taken = tl::expected<T, Refusal>;

/// Force of the floor on a foot or on the person; moments about the frame's origin, as sensors and
/// plates have them. The CoP is where its line of action meets the floor, less than 2 m from the
/// pelvis. A force without any horizontal part is that of a one-axis plate. Below 20 N a plate
/// shows noise: no force.
Taken<MeasuredGroundForce> ToGroundForce(const geometry_msgs::WrenchStamped& message,
                                         const FoundFrame& frame, const BodyNow& body);

/// A measured CoP, projected down to the floor.
Taken<Eigen::Vector3d> ToCop(const geometry_msgs::PointStamped& message, const FoundFrame& frame,
                             const BodyNow& body);

/// Force of the world on a hand. In a link's or the reference frame it acts at the grip point;
/// else at the frame's origin, less than 2 m from the hand.
Taken<MeasuredHandForce> ToHandForce(const geometry_msgs::WrenchStamped& message,
                                     const FoundFrame& frame, urdf::Side side, const BodyNow& body);

/// Loads of joints as another program has them; `scale` multiplies moments: -1 for a program that
/// means what the child exerts on the parent. Joints that are none of ours are counted in
/// `unknown_joints`.
struct ExternalLoads {
  std::array<ExternalJointLoad, urdf::kJointCount> joints;  // stamp_nanos: set by the caller
  std::array<bool, urdf::kJointCount> is_given{};
  int unknown_joints = 0;
};
Taken<ExternalLoads> ToExternalLoads(const kinescope_ros::JointLoadArray& message,
                                     const FoundFrame& frame, double scale);

/// `effort`: the moment about each joint's own axes (ours: y, then x, then z; with names in _rotx:
/// x, y, z on frames of the T-pose, as human-gazebo's URDFs); an axis that is not named carries
/// none. Without efforts, and with names without an axis: `position` is the ratio.
Taken<ExternalLoads> ToExternalLoads(const sensor_msgs::JointState& message, const BodyNow& body,
                                     double scale);

}  // namespace kinescope::ros_bridge
