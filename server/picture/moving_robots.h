/// The robots of the option --robot that transforms move.
#pragma once

#include <vector>

#include "core/graph_view.h"
#include "server/picture/view_options.h"

namespace kinescope::app {

/// Those of files are read. @throws SourceError with the file, line and reason
std::vector<GraphRobot> ReadMovingRobots(const std::vector<RobotPlace>& places);

/// What the options of a picture name of a bag. @throws as above; UsageError for a robot whose URDF
/// only a ROS graph has
GraphView ToBagView(const ViewOptions& options);

}  // namespace kinescope::app
