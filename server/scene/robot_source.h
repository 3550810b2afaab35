/// A URDF file as a robot that can be placed and drawn.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/scene_state.h"
#include "urdf/robot_kinematics.h"

namespace kinescope::app {

/// The bytes of a URDF; of as much of it as any reader takes, and one more.
/// @throws SourceError naming the file and why it cannot be read.
std::string ReadUrdfFile(const std::filesystem::path& path);

/// The robot in `path`, its root in the origin, its joints where `joints` says.
/// @throws SourceError naming the file, with the line and reason.
RobotState LoadRobot(const std::filesystem::path& path,
                     const std::vector<std::string>& package_path,
                     const urdf::JointPositions& joints = {});

/// Moves a robot as a whole: the middle of its bounds over `x`, `y`, the lowest point on z = 0.
/// @pre its bounds are known
void StandOnFloor(RobotState& robot, double x = 0, double y = 0);

}  // namespace kinescope::app
