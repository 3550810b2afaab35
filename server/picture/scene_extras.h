/// What a picture shows beside the scene of its recording, as the options say: robots, ghosts,
/// trails. What depends on the scenes before is collected here, in order. One thread.
#pragma once

#include <vector>

#include "core/scene_state.h"
#include "render/scene_look.h"
#include "server/picture/backend.h"
#include "server/picture/ghost_pose.h"
#include "server/picture/trails.h"
#include "server/picture/view_options.h"

namespace kinescope::app {

class SceneExtras {
 public:
  /// Reads robots and ghosts; measures the robots with a renderer of its own, where there are any.
  /// `people`: those of the pictures, which a ghost of a recording follows.
  /// @throws UsageError, SourceError naming option or file and the reason.
  SceneExtras(const ViewOptions& options, const BackendOptions& backend,
              const SceneOptions& people);

  /// How much of what was before a picture's time it shows, s; 0 without trails.
  double history_secs() const { return trails_.empty() ? 0 : trails_.secs(); }

  /// The next scene, whether it becomes a picture or not.
  void Remember(const SceneState& state) { trails_.Remember(state); }

  /// Robots to `state`, the rest to `look`; `state` is the one that was remembered last.
  void AddTo(SceneState& state, render::SceneLook& look) const;

 private:
  Trails trails_;
  GhostPose ghost_;
  std::vector<RobotState> robots_;  // standing on z = 0
};

}  // namespace kinescope::app
