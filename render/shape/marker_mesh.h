/// A SceneMarker as triangles in the world. No VTK here.
#pragma once

#include <cstddef>

#include "core/scene_marker.h"
#include "urdf/mesh/mesh.h"

namespace kinescope::render {

/// How many triangles AppendMarker would add; 0 for text and meshes.
std::size_t TriangleCount(const SceneMarker& marker);

/// Text and meshes add nothing. @pre !FindDefect(marker)
void AppendMarker(const SceneMarker& marker, urdf::Mesh& to);

}  // namespace kinescope::render
