/// A picture in memory: RGBA, 8 bits per channel, row-major, top row first, no padding. Plain data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace kinescope::render {

struct Image {
  int width = 0;                   // px
  int height = 0;                  // px
  std::vector<std::uint8_t> rgba;  // (height, width, 4)
};

/// Sets the size and reuses the memory. The caller must write all pixels afterwards.
inline void SetSize(Image& image, int width, int height) {
  image.width = width;
  image.height = height;
  image.rgba.resize(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
}

}  // namespace kinescope::render
