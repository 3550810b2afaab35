/// Draws a figure from its description with a Pen. One thread per figure.
#pragma once

#include <string>

#include "render/plot.h"

namespace kinescope::render::plot {

// As render::ToSvg and render::ToImage.
std::string DrawSvg(const Figure& figure);
Image DrawImage(const Figure& figure, double px_per_pt);

}  // namespace kinescope::render::plot
