/// Shifts a scene to the floor height that the rendering uses: z = 0.
#pragma once

#include "core/scene_state.h"
#include "render/camera/camera.h"
#include "render/renderer.h"

namespace kinescope::render {

/// Whether the floor is there already, in all views. Pure function, any thread.
bool IsLifted(const SceneState& state, const PictureSpec& spec);

/// Moves everything vertically so that the floor is at z = 0. Pure function, any thread.
void LiftToFloor(SceneState& state, Camera& camera, PictureSpec& spec);

}  // namespace kinescope::render
