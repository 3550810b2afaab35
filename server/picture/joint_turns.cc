#include "server/picture/joint_turns.h"

#include <Eigen/Geometry>

#include "urdf/segments.h"

namespace kinescope {

std::vector<JointTurn> JointTurnsOf(const SceneState& state) {
  std::vector<JointTurn> turns;
  for (const PersonState& person : state.people) {
    for (int joint = 0; joint < urdf::kJointCount; ++joint) {
      const auto turn_of = [&](int segment) -> const Eigen::Quaterniond& {
        return person.links[urdf::At(segment)].orientation;
      };
      const Eigen::Quaterniond turn =
          (turn_of(urdf::ParentOf(joint)).conjugate() * turn_of(urdf::ChildOf(joint))).normalized();
      if (!turn.coeffs().allFinite()) continue;
      turns.push_back({std::string(urdf::kJoints[urdf::At(joint)].ros_name),
                       person.character,
                       {turn.w(), turn.x(), turn.y(), turn.z()}});
    }
  }
  return turns;
}

}  // namespace kinescope
