/// Paints overlays as vectors: SVG, or PDF with searchable text. One thread per layer.
#pragma once

#include <memory>

#include "render/module.h"

namespace kinescope::render::plot {

/// @param width_mm  of the page; 0: at 96 px per inch, as CSS has it
/// @param below  pixels under it, in PDF; nullptr: none
/// @pre 0 < width_px, height_px; `below` has that size. @throws RenderError if a font is missing.
std::unique_ptr<LayerPainter> MakeLayer(int width_px, int height_px, double width_mm,
                                        LayerFormat format, const Image* below);

}  // namespace kinescope::render::plot
