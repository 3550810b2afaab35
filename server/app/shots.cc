#include "server/app/shots.h"

#include <utility>

namespace kinescope::app {

ShotPlanner::ShotPlanner(const ViewOptions& options)
    : camera_name_(options.camera), view_(ToView(options)) {
  render::NamedCamera(camera_name_, SceneState{});  // refuses an unknown name before any work
}

Shot ShotPlanner::Next(SceneState state) {
  const render::Camera camera = camera_.Aim(camera_name_, state);
  return {std::move(state), camera, view_};
}

Shot ShotPlanner::Only(SceneState state) const {
  const render::Camera camera = render::NamedCamera(camera_name_, state);
  return {std::move(state), camera, view_};
}

}  // namespace kinescope::app
