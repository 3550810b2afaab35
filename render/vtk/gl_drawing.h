/// The scene, drawn by VTK into memory on whatever kind of GL context the module has. The drawing,
/// and with it every actor, cache and context of this folder, belongs to the thread that made it.
#pragma once

#include <memory>
#include <string>

#include "render/module.h"

namespace kinescope::render {

/// @throws RenderError when there is no context of `backend`.
std::unique_ptr<Drawing> MakeGlDrawing(const std::string& backend, const LogLine& log);

}  // namespace kinescope::render
