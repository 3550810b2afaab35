/// Grey of a picture, for what looks at shapes and at light. Pure functions, any thread.
#pragma once

#include <cstdint>
#include <vector>

#include "render/image/image.h"

namespace kinescope::render {

/// Luma (ITU-R BT.601) of an sRGB pixel, 0 to 255, rounded to nearest.
inline std::uint8_t LumaOf(int red, int green, int blue) {
  return static_cast<std::uint8_t>((77 * red + 150 * green + 29 * blue + 128) >> 8);
}

/// Luma of a picture whose pixels are opaque. It has a margin at the right and below, so that it
/// consists of whole cells of 4 x 4 px and has at least 2 x 2 of them; the margin repeats the
/// outermost pixels.
struct LumaPlane {
  static constexpr int kCell = 4;  // px

  explicit LumaPlane(const Image& image);

  /// Pixels `from` to `to` of row `y`, without `to`, become those of `image`, which has the size of
  /// the plane's picture.
  void TakeRow(const Image& image, int y, int from, int to);
  /// After rows have been taken: the margin follows the outermost pixels.
  void FillMargin();

  const std::uint8_t* Row(int y) const { return &levels[static_cast<std::size_t>(y) * stride]; }
  std::uint8_t* Row(int y) { return &levels[static_cast<std::size_t>(y) * stride]; }
  int columns() const { return static_cast<int>(stride) / kCell; }  // of cells
  int rows() const { return static_cast<int>(levels.size() / stride) / kCell; }

  int width = 0, height = 0;         // px, without the margin
  std::size_t stride = 0;            // px from row to row
  std::vector<std::uint8_t> levels;  // (rows with margin, stride)
};

}  // namespace kinescope::render
