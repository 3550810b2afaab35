/// Averages supersampled pictures (anti-aliasing). Pure function, any thread.
#pragma once

#include <cstdint>

#include "render/image/image.h"

namespace kinescope::render {

/// Averages `factor` x `factor` boxes of `large`, which has `width * factor` columns and `height *
/// factor` rows of RGBA, and writes them to `target` at column x, row y. Rounds to nearest.
/// @pre factor is 1, 2 or 4 and the box is inside `target`
void AverageInto(const std::uint8_t* large, int width, int height, int factor, Image& target, int x,
                 int y);

}  // namespace kinescope::render
