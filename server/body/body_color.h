/// The colour of a person's body: who is who, while the spheres on it keep their meaning. sRGB.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/color_difference.h"
#include "core/palette.h"

namespace kinescope::app {

/// Of the `index`-th person that appeared, from 0. A colour of their own (type 12, MVNX;
/// 0xRRGGBB) keeps its hue, but is muted and lightened, so that the load classes stand out against
/// it at least by kLeastContrast. Without one: the first person's is kBodyColor, then comes a small
/// palette, over again when it is used up.
Rgb BodyColor(std::optional<std::uint32_t> own_rgb, std::size_t index);

/// How many people have a colour of their own before the palette repeats.
inline constexpr std::size_t kBodyColors = 7;

/// Of a body's colour to green, orange and red, as ColorDifference. About 2 is seen side by side.
inline constexpr double kLeastContrast = 20;

}  // namespace kinescope::app
