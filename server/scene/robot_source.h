/// Loads a URDF file as a robot that can be placed and rendered. World frame, metres. Any thread.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/scene_state.h"
#include "urdf/robot/mesh_uri.h"
#include "urdf/robot/robot_kinematics.h"
#include "urdf/robot/robot_model.h"

namespace kinescope::app {

/// The bytes of a URDF file, limited to one byte more than any URDF reader accepts.
/// @throws SourceError with the file and the reason.
std::string ReadUrdfFile(const std::filesystem::path& path);

/// Where the meshes of the robot in `path` are searched. Those on web servers are loaded: blocks.
/// @throws std::runtime_error where there is no folder for temporary files
urdf::MeshSearch SearchFor(const urdf::RobotModel& model, const std::filesystem::path& path,
                           const std::vector<std::string>& package_path);

/// The robot in `path`, its root at the origin, its joints at `joints` (others as in
/// urdf::PlaceLinks).
/// @throws SourceError with the file, line and reason.
RobotState ReadRobot(const std::filesystem::path& path,
                     const std::vector<std::string>& package_path,
                     const urdf::JointPositions& joints = {});

/// The URDF and the meshes that it draws, with the files behind them; what cannot be found is left
/// out. Never throws.
std::vector<std::filesystem::path> FilesOfRobot(const std::filesystem::path& urdf);

/// Its model becomes as opaque as before times `opacity`, 0..1.
void SetOpacity(RobotState& robot, double opacity);

/// `robot`, higher by `by`, m.
RobotState Lifted(RobotState robot, double by);

/// Moves the robot so that the middle of its bounds is above `x`, `y` (world, m) and its lowest
/// point is on z = 0. @pre its bounds are known
void StandOnFloor(RobotState& robot, double x = 0, double y = 0);

}  // namespace kinescope::app
