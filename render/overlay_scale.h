/// Computes and paints the scale bar: a round length, true at the depth of the camera's target (in
/// an orthographic picture: at any depth).
#pragma once

#include <string>

#include "render/camera/camera.h"
#include "render/overlay_page.h"

namespace kinescope::render {

struct ScaleBar {
  double length_m = 0;
  double length_px = 0;
  std::string text;  // "50 cm"
};

/// The longest of 1, 2 or 5 times a power of ten that is not longer than `most_px`; length 0 if the
/// target is behind the camera.
ScaleBar ScaleBarOf(const Camera& camera, int width_px, int height_px, double most_px);

/// Its right end is at the right margin of the page, its text ends `above_bottom` px above the
/// bottom.
void PaintScaleBar(OverlayPage& page, const Camera& camera, double above_bottom);

}  // namespace kinescope::render
