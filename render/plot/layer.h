/// Paints overlays as vectors: SVG, or PDF with searchable text. One thread per layer.
#pragma once

#include <memory>

#include "render/module.h"

namespace kinescope::render::plot {

/// @pre 0 < width_px, height_px. @throws RenderError if a font is missing.
std::unique_ptr<LayerPainter> MakeLayer(int width_px, int height_px, LayerFormat format);

}  // namespace kinescope::render::plot
