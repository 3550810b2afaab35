/// What of a scene can be drawn at all. A sample with a number that is not finite is refused where
/// it is read (server/mvn, server/ros); this is for whoever makes scenes otherwise.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/scene_state.h"

namespace kinescope::render {

/// `state` without people, load spheres, marks and objects whose place is not finite, or further
/// away than anything can be; nullopt when all of it can be drawn. Adds a line to `problems` for
/// each, naming it. (Links of robots are left out one by one where they are drawn.)
std::optional<SceneState> WithoutNonFinite(const SceneState& state,
                                           std::vector<std::string>& problems);

}  // namespace kinescope::render
