/// Mesh files that a URDF names: STL, DAE, OBJ, read by assimp.
#pragma once

#include <string>

#include "render/vtk/mesh.h"

namespace kinescope::render {

/// `uri`: file:///absolute/path or an absolute path. Metres, as the file says; COLLADA's up axis is
/// ignored, as RViz does, so that both show the same.
/// @throws std::runtime_error naming the file and what is wrong with it.
Mesh ReadMeshFile(const std::string& uri);

}  // namespace kinescope::render
