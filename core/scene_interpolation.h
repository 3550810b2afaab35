/// A scene between two samples, for clips on a fixed time grid.
#pragma once

#include <cstdint>

#include "core/scene_state.h"

namespace kinescope {

/// The scene `stamp_nanos` between `before` and `after`: poses (of gloves, props and objects too),
/// CoM and CoP interpolated, everything that is a decision (load classes, liveness) held from
/// `before`. People are matched by character, objects by their number within it; who is in `before`
/// only is held too. Outside the two stamps the nearer one is
/// returned.
[[nodiscard]] SceneState Interpolate(const SceneState& before, const SceneState& after,
                                     std::int64_t stamp_nanos);

}  // namespace kinescope
