/// Reads the PNG files that renderers and screenshots make, in a third of libpng's time: 8 bits per
/// channel, RGB or RGBA, not interlaced, in sRGB. Pure function, any thread.
#pragma once

#include <cstddef>
#include <cstdint>

#include "render/image/image.h"

namespace kinescope::render {

/// Fills `image` from a whole file. False, and `image` as it was: the file is of another kind,
/// larger than `most_side` px, or damaged, which libpng says better.
bool ReadPlainPng(const std::uint8_t* bytes, std::size_t size, int most_side, Image& image);

}  // namespace kinescope::render
