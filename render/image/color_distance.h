/// How different two colours look, for differences of pictures. Pure functions, any thread.
/// Source: Kotsarenko, Ramos (2010), Measuring perceived color difference using YIQ NTSC
/// transmission color space in mobile applications, Programacion Matematica y Software 2(2), 27-43.
/// core/color_difference.h (CIEDE2000) tells colours apart better and takes a hundred times as
/// long.
#pragma once

#include <cmath>
#include <cstdint>

namespace kinescope::render {

/// The square of the largest distance that two sRGB colours have, before it is scaled to 1.
inline constexpr float kLargestSquaredDistance = 35215.0F;

/// Squared distance of two opaque sRGB colours from their differences in levels; at most
/// kLargestSquaredDistance.
inline float UnscaledSquaredDistance(float red, float green, float blue) {
  const float y = 0.29889531F * red + 0.58662247F * green + 0.11448223F * blue;
  const float i = 0.59597799F * red - 0.27417610F * green - 0.32180189F * blue;
  const float q = 0.21147017F * red - 0.52261711F * green + 0.31114694F * blue;
  return 0.5053F * y * y + 0.299F * i * i + 0.1957F * q * q;
}

/// `UnscaledSquaredDistance` at a distance of 0 to 1.
inline float UnscaledSquare(double distance) {
  return static_cast<float>(distance * distance) * kLargestSquaredDistance;
}

/// 0 to 1: grey that differs by 13 levels is 0.049 apart, black and white are 0.966 apart.
inline double DistanceOf(float unscaled_squared) {
  return std::sqrt(static_cast<double>(unscaled_squared / kLargestSquaredDistance));
}

}  // namespace kinescope::render
