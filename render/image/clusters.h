/// Groups changed pixels that lie close together. One thread at a time.
#pragma once

#include <cstdint>
#include <vector>

#include "render/image/tile.h"

namespace kinescope::render {

struct Cluster {
  std::int64_t pixels = 0;
  Tile box;  // px, around its pixels
};

class ClusterFinder {
 public:
  /// Pixels of one square of this side or of neighbouring squares belong together, px.
  static constexpr int kCell = 8;

  ClusterFinder(int width, int height);

  /// @pre the pixel lies in the picture
  void Add(int x, int y);

  /// Of all added pixels, the largest first. Call it once.
  std::vector<Cluster> Take();

 private:
  struct Cell {
    int pixels = 0, left = 0, top = 0, right = 0, bottom = 0;  // inclusive
  };
  Cluster Collect(int column, int row);

  int columns_, rows_;
  std::vector<Cell> cells_;  // (rows, columns)
};

}  // namespace kinescope::render
