/// PersonState -> kinescope/JointLoadArray. Pure: no node, no clock.
#pragma once

#include <kinescope/JointLoadArray.h>

#include <string>
#include <string_view>

#include "core/scene_state.h"

namespace kinescope::ros_bridge {

/// The scored joints, in the order of PersonState::loads; what is not known is NaN, with its
/// reason.
void FillJointLoads(const PersonState& person, const std::string& reference_frame,
                    kinescope_ros::JointLoadArray& message);

/// What a joint's name in another program's message means.
struct NamedJoint {
  int joint = -1;       // urdf::Joint; -1: none of ours
  int axis = -1;        // 0, 1, 2: x, y, z; -1: the name has none
  bool is_rot = false;  // "_rotx": the chain of human-gazebo's URDFs, not ours
};

/// In any of the ways that programs write it: "jRightShoulder_rotx", "right_shoulder_x",
/// "skeleton_right_ball_foot", "human/jL5S1" (joint-loads.md 5.5, 5.6).
NamedJoint FindNamedJoint(std::string_view name);

}  // namespace kinescope::ros_bridge
