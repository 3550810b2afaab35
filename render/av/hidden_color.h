/// Colours under glass, for codecs that store colour for two by two pixels.
#pragma once

#include "render/image.h"

namespace kinescope::render::av {

/// Gives every pixel of alpha 0 the colour of what is visible near it: in its block of two by two
/// pixels, else in the blocks around that, else in the block that was filled before. What is seen
/// stays as it is; but an encoder, which averages over blocks, and a decoder, which interpolates
/// between them, no longer mix in what nobody sees.
/// @pre width and height are even
void HideColors(Image& image);

}  // namespace kinescope::render::av
