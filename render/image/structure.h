/// Structural similarity (SSIM) of two pictures: the same shapes in the same places? Pure function,
/// any thread.
/// Source: Wang, Bovik, Sheikh, Simoncelli (2004), Image quality assessment: from error visibility
/// to structural similarity, IEEE Trans. Image Process. 13(4), 600-612.
/// Of luma, in windows of 8 x 8 px of equal weight, one each 4 px; K1 0.01, K2 0.03, range 255,
/// population variances. The outermost pixels are repeated up to a multiple of 4 px.
#pragma once

#include <cstdint>
#include <vector>

#include "render/image/luma.h"
#include "render/image/tile.h"

namespace kinescope::render {

/// Side of the blocks of which the worst is named, px.
inline constexpr int kStructureBlock = 32;

struct Structure {
  double mean = 1;        // of all windows
  double worst = 1;       // mean of the windows that begin in `worst_block`
  Tile worst_block = {};  // px, within the picture; empty if all windows are the same
};

/// Number of blocks side by side that cover `pixels`.
inline int BlocksIn(int pixels) { return (pixels + kStructureBlock - 1) / kStructureBlock; }

/// @param changed  (block rows, block columns): other than 0 where the pictures differ. Where no
///                 window meets such a block, nothing is computed: the similarity is 1 there.
/// @pre both are of one size
Structure CompareStructure(const LumaPlane& expected, const LumaPlane& actual,
                           const std::vector<std::uint8_t>& changed);

}  // namespace kinescope::render
