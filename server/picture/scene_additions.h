/// Adds elements beside the recorded scene to a picture, according to the options: robots,
/// reference poses, trails. It collects the history that trails need, scene by scene, in order. One
/// thread.
#pragma once

#include <vector>

#include "core/scene_state.h"
#include "render/camera/framing.h"
#include "render/scene_look.h"
#include "server/picture/backend.h"
#include "server/picture/ghost_pose.h"
#include "server/picture/trails.h"
#include "server/picture/view_options.h"

namespace kinescope::app {

class SceneAdditions {
 public:
  /// Reads robots and reference poses; measures the robots, if any, with a renderer of its own.
  /// `people`: options of the people in the pictures, also used for a reference pose from a
  /// recording.
  /// @throws UsageError, SourceError with option or file and the reason.
  SceneAdditions(const ViewOptions& options, const BackendOptions& backend,
                 const SceneOptions& people);

  /// Length of the history that a picture shows, s; 0 without trails.
  double history_secs() const { return trails_.empty() ? 0 : trails_.secs(); }

  /// Adds the next scene, whether or not it becomes a picture.
  void Remember(const SceneState& state) { trails_.Remember(state); }

  /// What AddTo() adds beside the people of `state`, for the camera.
  std::vector<Ball> BallsBeside(const SceneState& state) const;

  /// Adds robots to `state` and the rest to `look`; `state` is the last one passed to Remember.
  void AddTo(SceneState& state, render::SceneLook& look) const;

  /// For a legend: what AddTo() may add to the pictures of a clip that begins with `state`. Trails
  /// have no points.
  void AddNamesTo(SceneState& state, render::SceneLook& look) const;

 private:
  void AddRobotsTo(SceneState& state, double floor_z) const;

  Trails trails_;
  GhostPose ghost_;
  std::vector<RobotState> robots_;  // standing on z = 0
};

}  // namespace kinescope::app
