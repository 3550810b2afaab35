/// Renders the scene with VTK into memory, on the GL context of the module. The drawing, and with
/// it every actor, cache and context of this folder, belongs to the thread that made it.
#pragma once

#include <memory>
#include <string>

#include "render/module.h"

namespace kinescope::render {

/// @throws RenderError if there is no context of `backend`.
std::unique_ptr<Drawing> MakeGlDrawing(const std::string& backend, const LogLine& log,
                                       const RegionSettings& regions);

}  // namespace kinescope::render
