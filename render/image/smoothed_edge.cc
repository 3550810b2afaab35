#include "render/image/smoothed_edge.h"

#include <algorithm>
#include <cstring>

namespace kinescope::render {
namespace {

struct Place {
  int x, y;
};

// The pixel itself and its neighbours, within the picture.
struct Surroundings {
  int left, top, right, bottom;
  bool is_at_border;
};

Surroundings Around(const Image& image, Place at) {
  const Surroundings around = {std::max(at.x - 1, 0), std::max(at.y - 1, 0),
                               std::min(at.x + 1, image.width - 1),
                               std::min(at.y + 1, image.height - 1), false};
  const bool is_inside = around.right - around.left == 2 && around.bottom - around.top == 2;
  return {around.left, around.top, around.right, around.bottom, !is_inside};
}

const std::uint8_t* PixelAt(const Image& image, Place at) {
  return &image.rgba[4 * (static_cast<std::size_t>(at.y) * image.width + at.x)];
}

// At least three neighbours have exactly its colour; the border of the picture counts as one.
bool IsInArea(const Image& image, Place at) {
  const Surroundings around = Around(image, at);
  const std::uint8_t* const own = PixelAt(image, at);
  int same = around.is_at_border ? 0 : -1;  // without itself
  for (int y = around.top; y <= around.bottom; ++y) {
    for (int x = around.left; x <= around.right; ++x) {
      same += static_cast<int>(std::memcmp(own, PixelAt(image, {x, y}), 4) == 0);
    }
  }
  return same >= 3;
}

// On an edge of the picture with this luma; which area the edge is of must be in both pictures.
bool IsOnEdge(const LumaPlane& luma, const PicturePair& pair, Place at) {
  const Surroundings around = Around(pair.expected, at);
  const int own = luma.Row(at.y)[at.x];
  int same = around.is_at_border ? 0 : -1;
  int darkest = 0, brightest = 0;  // against its own
  Place dark = at, bright = at;
  for (int y = around.top; y <= around.bottom; ++y) {
    for (int x = around.left; x <= around.right; ++x) {
      const int difference = luma.Row(y)[x] - own;
      same += static_cast<int>(difference == 0);
      if (difference < darkest) {
        darkest = difference;
        dark = {x, y};
      } else if (difference > brightest) {
        brightest = difference;
        bright = {x, y};
      }
    }
  }
  if (same > 2 || darkest == 0 || brightest == 0) return false;
  return (IsInArea(pair.expected, dark) && IsInArea(pair.actual, dark)) ||
         (IsInArea(pair.expected, bright) && IsInArea(pair.actual, bright));
}

}  // namespace

bool IsOnSmoothedEdge(const PicturePair& pair, int x, int y) {
  return IsOnEdge(pair.expected_luma, pair, {x, y}) || IsOnEdge(pair.actual_luma, pair, {x, y});
}

}  // namespace kinescope::render
