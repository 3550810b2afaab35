/// Those robots of the option --robot, which stand on the floor beside the people.
#pragma once

#include <vector>

#include "core/scene_state.h"
#include "server/picture/backend.h"
#include "server/picture/view_options.h"

namespace kinescope::app {

/// Reads them, and measures them with a renderer of its own, if there are any. Their lowest points
/// are on z = 0.
/// @throws SourceError with the file and the reason.
std::vector<RobotState> ReadStandingRobots(const std::vector<RobotPlace>& places,
                                           const BackendOptions& backend);

}  // namespace kinescope::app
