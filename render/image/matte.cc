#include "render/image/matte.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/system/check.h"

namespace kinescope::render {

void MatteOut(Image& picture, const Image& over_black) {
  KINESCOPE_CHECK(picture.width == over_black.width && picture.height == over_black.height);
  picture.floor = nullptr;
  for (std::size_t at = 0; at < picture.rgba.size(); at += 4) {
    std::uint8_t* white = &picture.rgba[at];
    const std::uint8_t* black = &over_black.rgba[at];
    // Rounding may let the channels disagree by a level. The largest alpha keeps every colour
    // within 0..255: white - black >= 255 - alpha means 255 - white <= alpha.
    int alpha = 0;
    for (int i = 0; i < 3; ++i) alpha = std::max(alpha, 255 - (white[i] - black[i]));
    alpha = std::min(alpha, 255);
    for (int i = 0; i < 3; ++i) {
      const int missing = 255 - white[i];  // of white, by the share that covers it
      white[i] =
          alpha == 0
              ? 0
              : static_cast<std::uint8_t>(std::max(0, 255 - (missing * 255 + alpha / 2) / alpha));
    }
    white[3] = static_cast<std::uint8_t>(alpha);
  }
}

void LayOver(Image& below, const Image& picture, const Tile& part, double opacity) {
  KINESCOPE_CHECK(part.width == below.width && part.height == below.height);
  KINESCOPE_CHECK(part.x >= 0 && part.x + part.width <= picture.width);
  KINESCOPE_CHECK(part.y >= 0 && part.y + part.height <= picture.height);
  constexpr double kMost = 255;
  const auto at = [](const Image& image, int x, int y) {
    return 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                static_cast<std::size_t>(x));
  };
  below.floor = nullptr;
  for (int y = 0; y < part.height; ++y) {
    const std::uint8_t* over = picture.rgba.data() + at(picture, part.x, part.y + y);
    std::uint8_t* pixel = below.rgba.data() + at(below, 0, y);
    for (int x = 0; x < part.width; ++x, over += 4, pixel += 4) {
      if (over[3] == 0) continue;
      const double share = opacity * over[3] / kMost;
      for (int i = 0; i < 3; ++i) {
        pixel[i] = static_cast<std::uint8_t>(std::lround(pixel[i] + share * (over[i] - pixel[i])));
      }
    }
  }
}

}  // namespace kinescope::render
