/// Writes a person's skin for use without Kinescope: Blender, game engines, viewers. Pure function,
/// any thread.
#pragma once

#include <string>

#include "core/scene_state.h"

namespace kinescope::app {

/// The built-in skin as a GLB (urdf/rig/skin_glb.h) in its bind pose, in the colours of the suit.
/// Borders between them follow the triangles. @pre model.has_built_in_surface
std::string SkinGlbOf(const PersonModel& model, bool has_skeleton = true);
/// In the posture and at the place of `person`. @pre person.model->has_built_in_surface
std::string PosedSkinGlbOf(const PersonState& person, bool has_skeleton = true);

}  // namespace kinescope::app
