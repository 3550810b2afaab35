/// What is written over the picture: title, lamp, legend, time code, banners, names, scale bar,
/// plot and strip. Sizes follow the picture's height, so that a clip of any size looks the same;
/// text never gets unreadably small. An Overlay belongs to one thread.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/scene_state.h"
#include "render/camera.h"
#include "render/label_layout.h"
#include "render/module.h"
#include "render/overlay_page.h"
#include "render/painter.h"
#include "render/renderer.h"

namespace kinescope::render {

/// One view of the scene within a picture, as it was drawn.
struct DrawnView {
  Tile tile;
  Camera camera;
  std::string name;           // "" where it is the only one
  std::vector<Label> labels;  // painted where they lie in the world
};

class Overlay {
 public:
  /// Over a picture of the size of `view`. @throws RenderError when a font is missing.
  void Paint(Painter& painter, const SceneState& state, const std::vector<DrawnView>& drawn,
             const View& view);

 private:
  using Page = OverlayPage;
  OverlayFonts& fonts();  // opened by the first picture that needs them

  void PaintView(Page& page, const SceneState& state, const DrawnView& drawn, const View& view,
                 bool has_time_code);
  void PaintAround(Page& page, const SceneState& state, const View& view);
  void PaintLamp(Page& page, const SceneState& state);
  void PaintTitle(Page& page, const SceneState& state, const View& view);
  struct LegendRow {
    Ink ink;
    double radius;  // px of 720
    bool has_rim;
    const char* name;
    std::string range;
    bool is_arrow;  // marked by one instead of a disc
  };
  /// Of what is shown and is there.
  static std::vector<LegendRow> LegendOf(const SceneState& state, const SceneLook& look);
  void PaintLegend(Page& page, const SceneState& state, const SceneLook& look);
  void PaintShortLegend(Page& page, const SceneState& state);
  void PaintTimeCode(Page& page, const SceneState& state);
  void PaintStaleBanner(Page& page, const SceneState& state);
  void PaintNoData(Page& page, const SceneState& state);
  void PaintNames(Page& page, const SceneState& state, const Camera& camera, bool has_names,
                  const std::vector<Label>& labels);
  void PaintLeader(Page& page, double x, double y, const LabelBox& box, const LabelPlace& place);
  void PaintMarkerText(Page& page, const Label& label, const Projected& at);

  std::unique_ptr<OverlayFonts> fonts_;
};

/// "hh:mm:ss.mmm"; negative times start with "-".
std::string TimeCode(std::int64_t millis);

}  // namespace kinescope::render
