/// Computes a picture with alpha from two opaque ones, rendered over white and over black. Exact
/// for everything that is blended over a background, however it was rendered. Pure function, any
/// thread.
#pragma once

#include "render/image/image.h"
#include "render/image/tile.h"

namespace kinescope::render {

/// `picture` was rendered over white, `over_black` over black; converts `picture` to straight
/// colours with alpha. Over white it looks as before, up to half a level.
/// @pre equal sizes
void MatteOut(Image& picture, const Image& over_black);

/// Lays the `part` of a picture with alpha over all of `below`, which is opaque.
/// @param opacity  0..1, of the part
/// @pre `part` is within `picture`, and as large as `below`
void LayOver(Image& below, const Image& picture, const Tile& part, double opacity);

}  // namespace kinescope::render
