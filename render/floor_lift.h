/// The drawing has the floor at z = 0; recordings do not.
#pragma once

#include "core/scene_state.h"
#include "render/camera.h"
#include "render/renderer.h"

namespace kinescope::render {

/// Raises everything so that the floor is at z = 0. Pure, any thread.
void LiftToFloor(SceneState& state, Camera& camera, View& view);

}  // namespace kinescope::render
