/// Sets the colour of fully transparent pixels, for codecs with 4:2:0 chroma subsampling. Pure
/// function, any thread.
#pragma once

#include "render/image/image.h"

namespace kinescope::render::av {

/// Gives every pixel with alpha 0 the colour of visible pixels near it: in its block of two by two
/// pixels, else in the blocks around that, else in the block filled before. Visible pixels do not
/// change. But an encoder, which averages over blocks, and a decoder, which interpolates between
/// them, no longer mix in invisible colours.
/// @pre width and height are even
void HideColors(Image& image);

}  // namespace kinescope::render::av
