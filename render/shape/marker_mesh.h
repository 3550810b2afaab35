/// Converts a SceneMarker to triangles in the world frame, metres. No VTK types. Pure functions,
/// any thread.
#pragma once

#include <cstddef>

#include "core/scene_marker.h"
#include "urdf/mesh/mesh.h"

namespace kinescope::render {

/// How many triangles a marker has in a picture; 0 for text and meshes.
std::size_t TriangleCount(const SceneMarker& marker);

/// Adds nothing for text, meshes and points, whose triangles turn with the camera.
/// @pre !FindDefect(marker)
void AppendMarker(const SceneMarker& marker, urdf::Mesh& to);

}  // namespace kinescope::render
