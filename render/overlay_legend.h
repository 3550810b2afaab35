/// Computes and paints the legend: the load classes with their limits, the other symbols of the
/// scene, what the load ratios are based on, and an assumed body mass. Internal to overlay*.cc.
#pragma once

#include <string>
#include <vector>

#include "core/scene_state.h"
#include "render/overlay_page.h"

namespace kinescope::render {

struct LegendRow {
  Ink ink;
  double radius;  // px in a picture 720 px high
  bool has_rim;
  std::string name;
  std::string range;
  bool is_arrow;  // the symbol is an arrow, not a disc
};

/// Rows for the elements that `look` shows and `state` contains, from top to bottom.
std::vector<LegendRow> LegendOf(const SceneState& state, const SceneLook& look);

/// Its box at the lower left corner, px, with the margins around it; the width of the picture where
/// only the classes are painted. Of a legend with all symbols that `look` may show.
struct LegendRoom {
  double width = 0, height = 0;
};
LegendRoom RoomOfLegend(const OverlaySizes& sizes, const SceneLook& look);

/// At the lower left. If it would be wider than three tenths of the page, which is where people
/// stand, only the classes are painted, in one line.
void PaintLegend(OverlayPage& page, const SceneState& state, const SceneLook& look);

}  // namespace kinescope::render
