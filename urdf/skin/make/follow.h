/// Moves the vertices of the skin from one build to another. Used when the program is built. Pure
/// functions, any thread.
#pragma once

#include <vector>

#include "urdf/skin/make/body_solid.h"

namespace kinescope::skin {

/// From the surface of `from` to that of `to`, in small steps along the normals.
std::vector<Point> Follow(std::vector<Point> vertices, const Build& from, const Build& to);

/// Does the same, and moves each vertex along the surface with its neighbours. The normals of a
/// furrow, such as that of the spine or an armpit, meet; without this, triangles there turn over.
/// @param triangles of a closed surface
std::vector<Point> FollowTogether(const std::vector<Point>& start,
                                  const std::vector<Triangle>& triangles, const Build& from,
                                  const Build& to);

}  // namespace kinescope::skin
