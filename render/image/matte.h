/// Computes a picture with alpha from two opaque ones, rendered over white and over black. Exact
/// for everything that is blended over a background, however it was rendered. Pure function, any
/// thread.
#pragma once

#include "render/image/image.h"

namespace kinescope::render {

/// `picture` was rendered over white, `over_black` over black; converts `picture` to straight
/// colours with alpha. Over white it looks as before, up to half a level.
/// @pre equal sizes
void MatteOut(Image& picture, const Image& over_black);

}  // namespace kinescope::render
