#include "render/multi_view.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/system/check.h"
#include "core/system/errors.h"

namespace kinescope::render {
namespace {

constexpr int kSmallestPane = 16;  // px, as of a picture

// `total` px cut into `count` pieces with `gap` px between, which differ by one at most.
Tile PieceOf(int total, int count, int gap, int index) {
  const int room = total - gap * (count - 1);
  const int from = room * index / count, to = room * (index + 1) / count;
  return {from + gap * index, 0, to - from, 0};
}

}  // namespace

std::vector<Tile> PaneTiles(int width_px, int height_px, int count, int columns) {
  KINESCOPE_CHECK(count >= 1 && columns >= 1 && columns <= count);
  const int rows = (count + columns - 1) / columns;
  const int gap = std::max(1, std::min(width_px, height_px) / 360);
  std::vector<Tile> tiles;
  for (int i = 0; i < count; ++i) {
    const int beside = std::min(columns, count - i / columns * columns);
    const Tile across = PieceOf(width_px, beside, gap, i % columns);
    const Tile down = PieceOf(height_px, rows, gap, i / columns);
    if (across.width < kSmallestPane || down.width < kSmallestPane) {
      throw UsageError(std::to_string(count) + " views in " + std::to_string(width_px) + "x" +
                       std::to_string(height_px) + " px would be smaller than " +
                       std::to_string(kSmallestPane) + " px each; use a larger picture");
    }
    tiles.push_back({across.x, down.x, across.width, down.width});
  }
  return tiles;
}

std::vector<Tile> PaneTiles(const Tile& scene, int count, int columns) {
  std::vector<Tile> tiles = PaneTiles(scene.width, scene.height, count, columns);
  for (Tile& tile : tiles) {
    tile.x += scene.x;
    tile.y += scene.y;
  }
  return tiles;
}

void CopyInto(Image& whole, const Image& part, const Tile& tile) {
  KINESCOPE_CHECK(part.width == tile.width && part.height == tile.height);
  KINESCOPE_CHECK(tile.x >= 0 && tile.x + tile.width <= whole.width);
  KINESCOPE_CHECK(tile.y >= 0 && tile.y + tile.height <= whole.height);
  whole.floor = nullptr;
  const auto row_bytes = 4 * static_cast<std::ptrdiff_t>(tile.width);
  for (int row = 0; row < tile.height; ++row) {
    const auto from = part.rgba.begin() + row * row_bytes;
    std::copy(from, from + row_bytes,
              whole.rgba.begin() +
                  4 * (static_cast<std::ptrdiff_t>(tile.y + row) * whole.width + tile.x));
  }
}

void FillWith(Image& image, const Tile& tile, const std::array<double, 3>& color) {
  KINESCOPE_CHECK(tile.x >= 0 && tile.x + tile.width <= image.width);
  KINESCOPE_CHECK(tile.y >= 0 && tile.y + tile.height <= image.height);
  std::array<std::uint8_t, 4> pixel = {0, 0, 0, 255};
  for (std::size_t i = 0; i < 3; ++i) {
    pixel.at(i) = static_cast<std::uint8_t>(std::lround(255 * color.at(i)));
  }
  image.floor = nullptr;
  for (int y = tile.y; y < tile.y + tile.height; ++y) {
    auto to = image.rgba.begin() + 4 * (static_cast<std::ptrdiff_t>(y) * image.width + tile.x);
    for (int x = 0; x < tile.width; ++x) to = std::copy(pixel.begin(), pixel.end(), to);
  }
}

}  // namespace kinescope::render
