/// Paints the legend beside the scene: in a strip under it, or in a column to its right. Internal
/// to overlay*.cc.
#pragma once

#include "render/legend_place.h"
#include "render/overlay_page.h"

namespace kinescope::render {

/// @pre `page` is the whole picture, and PlaceLegend() has set `spec.scene`.
void PaintLegendBeside(OverlayPage& page, const PictureSpec& spec);

}  // namespace kinescope::render
