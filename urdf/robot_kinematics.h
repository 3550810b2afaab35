/// Where the links of any robot are. (Of the human, with its own order of angles: kinematics.h.)
/// Pure functions, any thread.
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <string>
#include <vector>

#include "urdf/robot_model.h"

namespace kinescope::urdf {

/// rad or m, by joint.
using JointPositions = std::map<std::string, double>;

/// world_from_link in the order of `robot.links`. A joint that is not among `positions` is at 0, or
/// at the limit next to 0 where 0 is out of its limits; a given position is taken as it is. A joint
/// that mimics another follows it, unless it is given too. Floating and planar joints stay at their
/// origin. @throws UrdfError for a name that is no joint with a position.
std::vector<Eigen::Isometry3d> PlaceLinks(
    const RobotModel& robot, const JointPositions& positions = {},
    const Eigen::Isometry3d& world_from_root = Eigen::Isometry3d::Identity());

}  // namespace kinescope::urdf
