/// A part of a picture, made of squares. Plain data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/image/tile.h"

namespace kinescope::render {

class CellSet {
 public:
  /// px, the sides of the squares: those of a macroblock of a clip.
  static constexpr int kCell = 16;

  CellSet() = default;
  /// No square of a picture of `width` x `height` px.
  CellSet(int width, int height);

  void AddEverything();
  /// The squares that `tile` touches; what is outside of the picture is left out.
  void Add(const Tile& tile) {  // here, because it is called for each triangle and row of pixels
    const Tile inside = Intersection(tile, {0, 0, width_, height_});
    if (IsEmpty(inside)) return;
    const int first = inside.x / kCell, last = (inside.x + inside.width - 1) / kCell;
    const int bottom = (inside.y + inside.height - 1) / kCell;
    for (int row = inside.y / kCell; row <= bottom; ++row) {
      std::uint8_t* const line =
          is_in_.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_);
      for (int column = first; column <= last; ++column) line[column] = 1;
    }
  }
  /// @pre of a picture of the same size
  void Add(const CellSet& other);

  /// Covers the set; no two of them overlap. px
  std::vector<Tile> Rectangles() const;

 private:
  int width_ = 0, height_ = 0;       // px
  int columns_ = 0, rows_ = 0;       // squares
  std::vector<std::uint8_t> is_in_;  // row by row; 1: in the set
};

}  // namespace kinescope::render
