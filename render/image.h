/// A picture in memory: RGBA, 8 bits a channel, row-major, top row first, no padding.
#pragma once

#include <cstdint>
#include <vector>

namespace kinescope::render {

struct Image {
  int width = 0;                   // px
  int height = 0;                  // px
  std::vector<std::uint8_t> rgba;  // (height, width, 4)
};

}  // namespace kinescope::render
