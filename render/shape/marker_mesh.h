/// Converts a SceneMarker to triangles in the world frame, metres. No VTK types. Pure functions,
/// any thread.
#pragma once

#include <cstddef>

#include "core/scene_marker.h"
#include "urdf/mesh/mesh.h"

namespace kinescope::render {

/// How many triangles AppendMarker would add; 0 for text and meshes.
std::size_t TriangleCount(const SceneMarker& marker);

/// Adds nothing for text and meshes. @pre !FindDefect(marker)
void AppendMarker(const SceneMarker& marker, urdf::Mesh& to);

}  // namespace kinescope::render
