/// What a person rendered as a skin wears: quiet colours, each at least 20 (CIEDE2000) from every
/// load class. sRGB, 0..1. Pure functions, any thread.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace kinescope {

using Rgb = std::array<double, 3>;

struct SuitColors {
  Rgb top = {0.70, 0.73, 0.78}, trousers = {0.53, 0.56, 0.61}, shoes = {0.06, 0.07, 0.08};
  Rgb bare = {0.72, 0.69, 0.65};  // head and hands
  Rgb band = top;                 // around chest and upper arms: tells people apart
};

/// "#RRGGBB"; nullopt for any other text.
std::optional<Rgb> ColorFromHex(std::string_view text);
std::string ToHex(const Rgb& color);

}  // namespace kinescope
