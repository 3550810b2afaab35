/// Writes a person's skin for use without Kinescope: Blender, game engines, viewers. Pure function,
/// any thread.
#pragma once

#include <string>

#include "core/scene_state.h"

namespace kinescope::app {

/// The built-in skin as a GLB (urdf/rig/skin_glb.h), in the colours of the suit. Borders between
/// them follow the triangles. @pre model.has_built_in_surface
std::string SkinGlbOf(const PersonModel& model);

}  // namespace kinescope::app
