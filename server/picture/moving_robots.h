/// What options name of a ROS graph or a bag to be shown beside the people: robots that transforms
/// move, and topics.
#pragma once

#include <vector>

#include "core/graph_view.h"
#include "server/picture/view_options.h"
#include "server/scene/scene_builder.h"

namespace kinescope::app {

/// Those of files are read. @throws SourceError with the file, line and reason
std::vector<GraphRobot> ReadMovingRobots(const std::vector<RobotPlace>& places);

/// Adds what the options of a picture name of a bag to `scene`. @throws as above; UsageError for a
/// robot whose URDF only a ROS graph has
void AddBagView(const ViewOptions& options, SceneOptions& scene);

}  // namespace kinescope::app
