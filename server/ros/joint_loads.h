/// Converts PersonState to kinescope/JointLoadArray, and joint names from messages. Pure: no node,
/// no clock; any thread.
#pragma once

#include <kinescope/JointLoadArray.h>

#include <string>
#include <string_view>

#include "core/scene_state.h"

namespace kinescope::ros_bridge {

/// The scored joints, in the order of PersonState::loads; unknown values are NaN, with their
/// reason.
void FillJointLoads(const PersonState& person, const std::string& reference_frame,
                    kinescope_ros::JointLoadArray& message);

/// The joint that a name in a message of another program means.
struct NamedJoint {
  int joint = -1;       // urdf::Joint; -1: unknown
  int axis = -1;        // 0, 1, 2: x, y, z; -1: the name has none
  bool is_rot = false;  // "_rotx": the chain of human-gazebo's URDFs, which differs from
                        // Kinescope's
};

/// Accepts the usual spellings: "jRightShoulder_rotx", "right_shoulder_x",
/// "skeleton_right_ball_foot", "human/jL5S1" (joint-loads.md 5.5, 5.6).
NamedJoint FindNamedJoint(std::string_view name);

}  // namespace kinescope::ros_bridge
