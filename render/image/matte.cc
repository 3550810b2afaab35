#include "render/image/matte.h"

#include <algorithm>

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

}  // namespace kinescope::render
