/// Removes everything with a non-finite or absurdly distant position from a scene before rendering.
/// Such samples are rejected where they are read (server/mvn, server/ros); this is for scenes from
/// other code. Pure function, any thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/scene_state.h"

namespace kinescope::render {

/// `state` without people, load spheres, marks and objects whose position is not finite or too far
/// away; nullopt if everything can be rendered. Adds one line per removed element to `problems`.
/// (Links of robots are checked one by one when they are rendered.)
std::optional<SceneState> WithoutNonFinite(const SceneState& state,
                                           std::vector<std::string>& problems);

}  // namespace kinescope::render
