/// Paints the plot strip: chosen loads over time, one row each, with the class bands behind and a
/// cursor at the time of the picture.
#pragma once

#include <array>
#include <cstddef>

#include "render/load_curves.h"
#include "render/overlay_page.h"

namespace kinescope::render {

/// Of its panel for `rows` curves, px.
struct PlotRoom {
  double top = 0, width = 0, height = 0;
};
PlotRoom RoomOfPlot(const OverlaySizes& sizes, std::size_t rows);

/// At the upper right, between `top` and `bottom`, px. Rows without room are omitted, and the last
/// row shows their number. `class_limits`: SceneState::class_limits.
void PaintPlot(OverlayPage& page, const LoadCurves& loads,
               const std::array<double, 2>& class_limits, double now_secs, double top,
               double bottom);

}  // namespace kinescope::render
