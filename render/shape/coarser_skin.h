/// Skins of fewer triangles, for pictures in which a person is small. Pure functions, any thread.
#pragma once

#include <functional>

#include "render/shape/fine_normals.h"
#include "urdf/skeleton.h"
#include "urdf/skin/skin_template.h"

namespace kinescope::render {

struct CoarserSkin {
  skin::SkinTemplate skin;
  FineNormals normals;  // those of the whole skin, for the same light
};

/// `skin` with as few triangles as the error permits and the vertices that they use, in their
/// order. Triangles remain where the skin bends, because it is seen bent: see CoarserTriangles().
/// @param error_m how far the surface of a person of `build` and `skeleton` may move, m, > 0
/// @param is_kept triangles that stay as they are
CoarserSkin MakeCoarserSkin(const skin::SkinTemplate& skin, const skin::Build& build,
                            const urdf::Skeleton& skeleton, double error_m,
                            const std::function<bool(const skin::Triangle&)>& is_kept);
/// Of a suit, triangles with borders stay as they are where the error is at most 2 mm.
CoarserSkin MakeCoarserSkin(const skin::SkinTemplate& skin, const skin::Build& build,
                            const urdf::Skeleton& skeleton, double error_m);

}  // namespace kinescope::render
