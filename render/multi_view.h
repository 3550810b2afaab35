/// Several views of one scene in one picture, row by row, with thin lines between.
#pragma once

#include <array>
#include <vector>

#include "render/image.h"
#include "render/tile.h"

namespace kinescope::render {

/// Where `count` views lie in a picture; those of a last, shorter row share its width.
/// @pre count >= 1, 1 <= columns <= count; @throws UsageError where a view would be under 16 px.
std::vector<Tile> PaneTiles(int width_px, int height_px, int count, int columns);

/// @pre `part` is as large as `tile`, which lies within `whole`.
void CopyInto(Image& whole, const Image& part, const Tile& tile);

/// All pixels in one opaque colour.
void FillWith(Image& image, const std::array<double, 3>& color);

}  // namespace kinescope::render
