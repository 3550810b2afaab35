/// Names of colours, as Qt and therefore RViz takes them: those of SVG. Pure function.
#pragma once

#include <optional>
#include <string>

#include "core/suit_colors.h"

namespace kinescope::app::rviz {

/// "light blue" and "LightBlue" for "lightblue"; nullopt: there is none of that name.
std::optional<Rgb> FindColorByName(const std::string& text);

}  // namespace kinescope::app::rviz
