#include "server/body/body_color.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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

std::optional<NearClass> FindNearClass(const Rgb& color) {
  std::optional<NearClass> nearest;
  for (const LoadClass load_class : kLoadClasses) {
    const double difference = ColorDifference(color, ColorOf(load_class));
    if (difference >= (nearest ? nearest->difference : kMinContrast)) continue;
    nearest = {load_class, difference};
  }
  return nearest;
}

Rgb NearestSafeColor(const Rgb& color) {
  if (!FindNearClass(color)) return color;
  constexpr int kSteps = 32;  // of each channel
  Rgb best{};
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kSteps * kSteps * kSteps; ++i) {
    const auto channel = [](int step) { return std::round(step * 255.0 / (kSteps - 1)) / 255; };
    const Rgb other = {channel(i % kSteps), channel(i / kSteps % kSteps),
                       channel(i / kSteps / kSteps)};
    const double difference = ColorDifference(color, other);
    if (difference >= least || FindNearClass(other)) continue;
    least = difference;
    best = other;
  }
  return best;
}

SuitColors SuitOf(const Rgb& body, const std::optional<Rgb>& suit) {
  SuitColors colors;
  if (suit) {
    colors.top = colors.trousers = *suit;
    const Lab lab = ToLab(*suit);
    for (const double shade : {0.78, 0.7, 0.85, 0.6, 1.15, 1.0}) {
      colors.trousers = ToRgb({shade * lab.l, shade * lab.a, shade * lab.b});
      if (!FindNearClass(colors.trousers)) break;
    }
  }
  colors.band = body == kBodyColor ? colors.top : body;
  return colors;
}

}  // namespace kinescope::app
