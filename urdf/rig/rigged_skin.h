/// Makes a skin (urdf/skin) of a rigged person: brings the surface from the pose of its file to the
/// bind pose of the reference body, whatever its unit, axes and proportions are, and hangs it on
/// the skin's frames. From then on it is fitted to people, posed and drawn as the built-in skin is.
/// Pure functions, any thread.
#pragma once

#include <cstddef>

#include "urdf/rig/rig.h"
#include "urdf/skin/skin_template.h"

namespace kinescope::rig {

/// Vertices are numbered with 16 bits, also on the page.
inline constexpr std::size_t kMaxVertices = 65'536;

/// Vertices that differ only in what is not drawn are merged.
/// @throws std::runtime_error with the reason and the way out: missing bones, bones of no length,
/// left and right exchanged, too many vertices.
skin::SkinTemplate SkinOf(const Rig& rig);

}  // namespace kinescope::rig
