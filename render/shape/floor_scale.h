/// Metres on the floor's grid, as labels along two of its lines in front of what the camera looks
/// at.
#pragma once

#include <vector>

#include "render/module.h"

namespace kinescope::render {

void AddFloorScale(const Camera& camera, std::vector<Label>& labels);

}  // namespace kinescope::render
