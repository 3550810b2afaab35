/// Computes the link poses of any robot. (For the human, with its own order of angles, see
/// kinematics.h.) Pure functions, any thread.
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <string>
#include <vector>

#include "urdf/robot/robot_model.h"

namespace kinescope::urdf {

/// Joint position by joint name, rad or m.
using JointPositions = std::map<std::string, double>;

/// world_from_link in the order of `robot.links`. A joint without an entry in `positions` is at 0,
/// or at the limit nearest to 0 if 0 is outside its limits; a given position is used unchanged. A
/// mimic joint follows its joint unless it has an entry itself. Floating and planar joints stay at
/// their origin. @throws UrdfError for a name that is not a joint with a position.
std::vector<Eigen::Isometry3d> PlaceLinks(
    const RobotModel& robot, const JointPositions& positions = {},
    const Eigen::Isometry3d& world_from_root = Eigen::Isometry3d::Identity());

}  // namespace kinescope::urdf
