/// Interpolates between two scenes, for clips with a fixed frame rate. Pure function, any thread.
#pragma once

#include <cstdint>

#include "core/scene_state.h"

namespace kinescope {

/// The scene at `stamp_nanos`, between `before` and `after`. Poses (also of gloves, props and
/// objects), CoM and CoP are interpolated. Discrete values (load classes, liveness) are those of
/// `before`. People are matched by character, objects by character and number; those that are only
/// in `before` do not move. Outside the two stamps the nearer scene is returned.
[[nodiscard]] SceneState Interpolate(const SceneState& before, const SceneState& after,
                                     std::int64_t stamp_nanos);

}  // namespace kinescope
