/// Divides a picture into the scene and a legend beside it. Pure function, any thread.
#pragma once

#include "render/legend.h"
#include "render/renderer.h"

namespace kinescope::render {

/// Makes room for the legend of `spec` where it is below or outside: sets `spec.scene` and
/// `spec.legend_content`. No effect where the legend is inside, off or empty.
/// @throws UsageError if less than two fifths of the picture would be left for the scene;
/// RenderError if a font is missing.
void PlaceLegend(PictureSpec& spec, const LegendContent& content);

}  // namespace kinescope::render
