/// Adds labels in metres along two lines of the floor's grid, in front of the camera's target. Pure
/// function, any thread.
#pragma once

#include <vector>

#include "render/module.h"

namespace kinescope::render {

void AddFloorScale(const Camera& camera, std::vector<Label>& labels);

}  // namespace kinescope::render
