/// A rectangle of a picture, px, from its top left corner.
#pragma once

#include <algorithm>

namespace kinescope::render {

struct Tile {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

inline bool IsEmpty(const Tile& tile) { return tile.width <= 0 || tile.height <= 0; }

/// What both cover; empty if they do not meet.
inline Tile Intersection(const Tile& a, const Tile& b) {
  const int x = std::max(a.x, b.x), y = std::max(a.y, b.y);
  return {x, y, std::min(a.x + a.width, b.x + b.width) - x,
          std::min(a.y + a.height, b.y + b.height) - y};
}

}  // namespace kinescope::render
