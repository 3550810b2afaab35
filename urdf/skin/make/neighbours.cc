#include "urdf/skin/make/neighbours.h"

#include <algorithm>

namespace kinescope::skin {

Neighbours NeighboursOf(std::size_t vertices, const std::vector<Triangle>& triangles) {
  Neighbours all(vertices);
  for (const Triangle& triangle : triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      all[triangle[c]].push_back(triangle[(c + 1) % 3]);
      all[triangle[c]].push_back(triangle[(c + 2) % 3]);
    }
  }
  for (std::vector<std::uint16_t>& each : all) {
    std::sort(each.begin(), each.end());
    each.erase(std::unique(each.begin(), each.end()), each.end());
  }
  return all;
}

}  // namespace kinescope::skin
