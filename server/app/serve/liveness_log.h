/// Logs when the stream starts, stops and resumes; never once per sample. One thread.
#pragma once

#include <optional>

#include "core/scene_state.h"

namespace kinescope::app {

class LivenessLog {
 public:
  void OnState(const SceneState& state);

 private:
  std::optional<Liveness> logged_;
};

}  // namespace kinescope::app
