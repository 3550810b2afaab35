/// Which vertices of a surface share an edge. Used when the program is built. Pure function, any
/// thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "urdf/skin/skin_template.h"

namespace kinescope::skin {

using Neighbours = std::vector<std::vector<std::uint16_t>>;

/// Of each vertex, ascending.
Neighbours NeighboursOf(std::size_t vertices, const std::vector<Triangle>& triangles);

}  // namespace kinescope::skin
