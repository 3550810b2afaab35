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

/// The suit of a person with this BodyColor(): the bands have it, the rest is quiet. With a
/// `suit` of its own, top and trousers have its hue.
SuitColors SuitOf(const Rgb& body, const std::optional<Rgb>& suit);

/// The load class whose colour is nearer than kMinContrast, as `--body_color` must not be; nullopt:
/// none.
struct NearClass {
  LoadClass load_class = LoadClass::kUnknown;
  double difference = 0;  // CIEDE2000
};
std::optional<NearClass> FindNearClass(const Rgb& color);
/// The most similar colour that is near none.
Rgb NearestSafeColor(const Rgb& color);

/// Number of people with different colours before the palette repeats.
inline constexpr std::size_t kBodyColors = 7;

/// Of the body's colour to green, orange and red (of a suit's: to grey, too), as ColorDifference.
/// About 2 is visible when adjacent.
inline constexpr double kMinContrast = 20;

}  // namespace kinescope::app
