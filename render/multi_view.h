/// Arranges several views of one scene in one picture, row by row, separated by thin lines. Pure
/// functions, any thread.
#pragma once

#include <array>
#include <vector>

#include "render/image/image.h"
#include "render/image/tile.h"

namespace kinescope::render {

/// The places of `count` views in a picture; those of a shorter last row share its width.
/// @pre count >= 1, 1 <= columns <= count; @throws UsageError if a view would be smaller than 16
/// px.
std::vector<Tile> PaneTiles(int width_px, int height_px, int count, int columns);
/// In the part of a picture that shows the scene.
std::vector<Tile> PaneTiles(const Tile& scene, int count, int columns);

/// @pre `part` is as large as `tile`, which is within `whole`.
void CopyInto(Image& whole, const Image& part, const Tile& tile);

/// Sets all pixels of `tile` to one opaque colour. @pre `tile` is within `image`.
void FillWith(Image& image, const Tile& tile, const std::array<double, 3>& color);

}  // namespace kinescope::render
