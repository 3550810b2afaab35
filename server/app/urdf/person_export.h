/// A person as files that others can use without Kinescope: RViz, Gazebo, a ROS package.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "server/body/figure_files.h"
#include "urdf/human_urdf.h"

namespace kinescope::app {

struct PersonFiles {
  std::vector<FigureFile> figure;  // FigureFiles; none for a figure of primitives
  std::vector<FigureFile> tools;   // ToolFiles
};

/// Writes `folder`/person.urdf and `meshes` into `folder`/meshes; makes the folders. The URDF names
/// them as package://`package`/meshes/..., so that `folder` is, or goes into, the package of that
/// name; where `package` is "", as file:// URIs of where they now are. Each file appears under its
/// name only when it is whole, the URDF last. What is there is replaced.
/// @throws UsageError naming the file and the reason, or a package name that ROS would not take.
void ExportPerson(urdf::HumanModel human, const PersonFiles& meshes,
                  const std::filesystem::path& folder, const std::string& package);

}  // namespace kinescope::app
