/// Writes a person as files for use without Kinescope: RViz, Gazebo, a ROS package. Any thread.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "server/body/body_meshes.h"
#include "urdf/human_urdf.h"

namespace kinescope::app {

struct PersonFiles {
  std::vector<MeshFile> body;   // from BodyMeshFiles; empty for a body of primitives
  std::vector<MeshFile> tools;  // from ToolMeshFiles
};

/// Writes `folder`/person.urdf and `meshes` into `folder`/meshes; creates the folders. The URDF
/// refers to them as package://`package`/meshes/..., so `folder` must be, or be copied to, the
/// package of that name. If `package` is "", it refers to their present place by file:// URIs. Each
/// file gets its name only when complete, the URDF last. Existing files are replaced.
/// @throws UsageError with the file and the reason, or for a package name that is invalid in ROS.
void ExportPerson(urdf::HumanModel human, const PersonFiles& meshes,
                  const std::filesystem::path& folder, const std::string& package);

}  // namespace kinescope::app
