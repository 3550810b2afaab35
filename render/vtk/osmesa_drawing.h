/// The scene, drawn by VTK into memory on a GL context of OSMesa.
#pragma once

#include <memory>

#include "render/module.h"

namespace kinescope::render {

/// @throws RenderError when there is no context.
std::unique_ptr<Drawing> MakeOsmesaDrawing(const LogLine& log);

}  // namespace kinescope::render
