/// How far the joints of people are bent, as plain numbers: for golden cases, which name the joint
/// that has changed whatever is seen of it. Pure functions, any thread.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/scene_state.h"

namespace kinescope {

struct JointTurn {
  std::string joint;  // "right_elbow"
  int character = 0;  // of its person
  /// Rotation of the child segment's frame in the parent's: quaternion w, x, y, z of length 1.
  std::array<double, 4> parent_from_child = {1, 0, 0, 0};
};

/// Of all people, in the order of urdf::kJoints; without those that are not finite.
std::vector<JointTurn> JointTurnsOf(const SceneState& state);

}  // namespace kinescope
