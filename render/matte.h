/// A picture with alpha from two opaque ones: what shows through is what the background changes.
/// Exact for anything that is blended over a background, however it was drawn.
#pragma once

#include "render/image.h"

namespace kinescope::render {

/// `picture` was drawn over white and `over_black` is the same over black; turns `picture` into
/// straight colours with alpha. Laid over white, it is what it was to half a level.
/// @pre equal sizes
void MatteOut(Image& picture, const Image& over_black);

}  // namespace kinescope::render
