/// Which frames carry each vertex of the skin, and by how much: coordinates along the limbs and the
/// spine in the bind pose, evened out over the surface. Used when the program is built. Pure
/// functions, any thread.
#pragma once

#include <vector>

#include "urdf/skin/make/body_solid.h"

namespace kinescope::skin {

/// Of a closed surface in the bind pose of `body`.
std::vector<VertexWeights> MakeWeights(const BodySolid& body, const std::vector<Point>& vertices,
                                       const std::vector<Triangle>& triangles);

}  // namespace kinescope::skin
