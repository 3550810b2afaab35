/// Where live pictures have room for people, picture after picture. One thread at a time.
#pragma once

#include <vector>

#include "core/scene_state.h"
#include "render/camera/held_view.h"
#include "render/legend.h"
#include "render/renderer.h"

namespace kinescope::app {

class PictureShapes {
 public:
  /// Of a picture of one view. Where overlays are is measured again only for another size or
  /// another legend.
  render::ViewShape Of(const render::PictureSpec& spec, const SceneState& state);

 private:
  struct Measured {
    int width = 0, height = 0;
    bool has_overlays = false;
    render::LegendContent legend;
    render::ViewShape shape;
  };
  std::vector<Measured> measured_;  // of the live picture, and of others
};

}  // namespace kinescope::app
