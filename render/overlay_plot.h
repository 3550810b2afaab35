/// The plot strip: chosen loads over time, one row each, with the classes behind and a cursor at
/// the picture's time.
#pragma once

#include <array>

#include "render/load_history.h"
#include "render/overlay_page.h"

namespace kinescope::render {

/// In the upper right, below `top`, down to `bottom` at most: rows for which there is no room are
/// left out, and the last row says how many. `class_limits`: those of the scene
/// (SceneState::class_limits).
void PaintPlot(OverlayPage& page, const LoadHistory& history,
               const std::array<double, 2>& class_limits, double now_secs, double top,
               double bottom);

}  // namespace kinescope::render
