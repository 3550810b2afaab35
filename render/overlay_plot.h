/// The plot strip: chosen loads over time, one row each, with the classes behind and a cursor at
/// the picture's time.
#pragma once

#include "render/load_history.h"
#include "render/overlay_page.h"

namespace kinescope::render {

/// In the upper right, below `top`, down to `bottom` at most: rows for which there is no room are
/// left out, and the last row says how many.
void PaintPlot(OverlayPage& page, const LoadHistory& history, double now_secs, double top,
               double bottom);

}  // namespace kinescope::render
