/// Where the overlays of a picture leave room for people. Pure function, any thread.
#pragma once

#include <cstddef>
#include <vector>

#include "render/camera/framing.h"
#include "render/image/tile.h"
#include "render/legend.h"
#include "render/renderer.h"

namespace kinescope::render {

/// Of each view, in its own picture. `curves`: in the plot. `legend`: entries of a legend inside
/// that are known before the pictures are. @throws RenderError if a font is missing.
std::vector<FreeArea> FreeAreasOf(const PictureSpec& spec, const std::vector<Tile>& views,
                                  std::size_t curves, const LegendContent& legend = {});

}  // namespace kinescope::render
