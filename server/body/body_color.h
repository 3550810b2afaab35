/// Chooses the colour of a person's body, so that people can be distinguished and the colours of
/// the load classes keep their meaning. sRGB. Pure function, any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/color_difference.h"
#include "core/palette.h"

namespace kinescope::app {

/// Colour of the `index`-th person that appeared, from 0. A person's own colour (type 12, MVNX;
/// 0xRRGGBB) keeps its hue, but is muted and lightened, so that its contrast to the load classes is
/// at least kMinContrast. Without one, the first person has kBodyColor and the next ones the
/// colours of a small palette, which repeats.
Rgb BodyColor(std::optional<std::uint32_t> own_rgb, std::size_t index);

/// Number of people with different colours before the palette repeats.
inline constexpr std::size_t kBodyColors = 7;

/// Of the body's colour to green, orange and red, as ColorDifference. About 2 is visible when
/// adjacent.
inline constexpr double kMinContrast = 20;

}  // namespace kinescope::app
