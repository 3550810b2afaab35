/// Lays out and paints the legend within the picture, at its lower left. Internal to overlay*.cc.
#pragma once

#include <array>

#include "render/legend.h"
#include "render/overlay_page.h"

namespace kinescope::render {

/// Its box at the lower left corner, px, with the margins around it; the width of the picture where
/// only the classes are painted. Of a legend with all symbols that `look` may show, and `additions`
/// beside them: LegendRow::is_addition.
struct LegendRoom {
  double width = 0, height = 0;
};
LegendRoom RoomOfLegend(const OverlaySizes& sizes, const SceneLook& look,
                        const LegendContent& additions = {});

/// At the lower left. If it would be wider than three tenths of the page, which is where people
/// stand, only the classes are painted, in one line. Additions without room are counted.
/// `class_limits`: SceneState::class_limits.
void PaintLegend(OverlayPage& page, const LegendContent& content,
                 const std::array<double, 2>& class_limits);

/// The symbol of `row`, centred at x, y, px.
void PaintLegendSymbol(OverlayPage& page, const LegendRow& row, double x, double y);

}  // namespace kinescope::render
