/// Draws a plot from its description with a Pen. One thread per plot.
#pragma once

#include <string>

#include "render/plot.h"

namespace kinescope::render::plot {

// As render::ToSvg and render::ToImage.
std::string DrawSvg(const Plot& plot);
Image DrawImage(const Plot& plot, double px_per_pt);

}  // namespace kinescope::render::plot
