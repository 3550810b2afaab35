/// Loads the meshes of robots that are on web servers, so that they are files as others are.
#pragma once

#include <cstddef>
#include <functional>

#include "server/download/web_file.h"
#include "urdf/robot/mesh_uri.h"
#include "urdf/robot/robot_model.h"

namespace kinescope::download {

struct RobotMeshLimits {
  WebLimits of_file;
  std::size_t most_bytes_of_all = std::size_t{512} << 20;
  std::size_t most_files = 1000;
};

/// How many meshes of `model` are on web servers (http://, https://).
[[nodiscard]] std::size_t CountRemoteMeshes(const urdf::RobotModel& model);

/// Loads them, and the materials of an OBJ beside it, into a temporary folder that is deleted with
/// the last copy of `search`, which finds them afterwards, or says why not. A server that does not
/// answer is asked once. Blocks; any thread.
/// @param is_stopped  as that of WebLoader
/// @throws std::runtime_error where there is no folder for temporary files
void LoadRemoteMeshes(const urdf::RobotModel& model, urdf::MeshSearch& search,
                      const std::function<bool()>& is_stopped = nullptr,
                      const RobotMeshLimits& limits = {});

}  // namespace kinescope::download
