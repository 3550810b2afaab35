/// What is written over the picture: title, lamp, legend, time code, banners, names. Sizes follow
/// the picture's height, so that a clip of any size looks the same; text never gets unreadably
/// small.
#pragma once

#include <string>
#include <vector>

#include "render/camera.h"
#include "render/canvas.h"
#include "render/font.h"
#include "render/image.h"
#include "render/module.h"
#include "render/renderer.h"
#include "server/core/scene_state.h"

namespace kinescope::render {

class Overlay {
 public:
  /// `labels` are drawn where they lie in the world. @throws RenderError when a font is missing.
  void Paint(Image& image, const SceneState& state, const Camera& camera, const View& view,
             const std::vector<Label>& labels);

 private:
  struct Page;  // one picture being painted
  struct Fonts {
    Font regular{"DejaVuSans.ttf"};
    Font bold{"DejaVuSans-Bold.ttf"};
  };
  Fonts& fonts();  // opened by the first picture that needs them

  void PaintLamp(Page& page, const SceneState& state);
  void PaintTitle(Page& page, const std::string& title);
  void PaintLegend(Page& page, const SceneState& state);
  void PaintTimeCode(Page& page, const SceneState& state);
  void PaintStaleBanner(Page& page, const SceneState& state);
  void PaintNoData(Page& page, const SceneState& state);
  void PaintNames(Page& page, const SceneState& state, const Camera& camera,
                  const std::vector<Label>& labels);

  std::unique_ptr<Fonts> fonts_;
};

/// "hh:mm:ss.mmm"; negative times start with "-".
std::string TimeCode(std::int64_t millis);

}  // namespace kinescope::render
