/// From scenes to pictures of a recording: what depends on the scenes before (a camera that
/// follows) is decided here, one scene after the other, so that the pictures themselves can be
/// drawn in any order and by any number of renderers.
#pragma once

#include "render/camera.h"
#include "render/renderer.h"
#include "server/app/view_options.h"
#include "server/core/scene_state.h"

namespace kinescope::app {

/// All that one picture depends on.
struct Shot {
  SceneState state;
  render::Camera camera;
  render::View view;
};

class ShotPlanner {
 public:
  /// @throws UsageError for what `options` ask for that there is not.
  explicit ShotPlanner(const ViewOptions& options);

  /// Of a clip: the scenes in order.
  Shot Next(SceneState state);

  /// Of one scene alone.
  Shot Only(SceneState state) const;

  const render::View& view() const { return view_; }

 private:
  std::string camera_name_;
  render::View view_;
  render::SteadyCamera camera_;
};

}  // namespace kinescope::app
