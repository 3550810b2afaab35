#include "server/body/body_color.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace kinescope::app {
namespace {

// As light as the first person's, and so little coloured that no hue comes near a class.
constexpr double kLightness = 81;
constexpr double kMaxChroma = 18;

Rgb Muted(double hue, double chroma) {
  return ToRgb({kLightness, chroma * std::cos(hue), chroma * std::sin(hue)});
}

}  // namespace

Rgb BodyColor(std::optional<std::uint32_t> own_rgb, std::size_t index) {
  if (own_rgb) {
    const auto channel = [&](int shift) { return (*own_rgb >> shift & 0xFF) / 255.0; };
    const Lab own = ToLab({channel(16), channel(8), channel(0)});
    return Muted(std::atan2(own.b, own.a), std::min(own.chroma(), kMaxChroma));
  }
  // Aqua, sand, mauve, sage, rose, sky: hues in degrees, neighbours in the list far apart.
  constexpr std::array<double, kBodyColors - 1> kHues = {200, 75, 320, 130, 20, 255};
  index %= kBodyColors;
  return index == 0 ? kBodyColor : Muted(kHues[index - 1] * M_PI / 180, kMaxChroma);
}

}  // namespace kinescope::app
