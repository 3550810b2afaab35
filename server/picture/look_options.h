/// Option texts to the look of a scene.
#pragma once

#include <string>

#include "render/scene_look.h"
#include "server/picture/view_options.h"

namespace kinescope::app {

/// Without trails and ghosts, which ShotPlanner adds. @throws UsageError naming option, value and
/// what was expected.
render::SceneLook ToLook(const ViewOptions& options);

}  // namespace kinescope::app
