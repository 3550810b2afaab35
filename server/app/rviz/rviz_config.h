/// A configuration of RViz for what a node publishes. Pure function, any thread.
#pragma once

#include <string>

#include "server/ros/running.h"

namespace kinescope::app {

/// `usual` (launch/kinescope.rviz) with the displays, topics and frames of `node`: a robot model
/// and markers for each person, and the rendered view if there is one. The camera follows the
/// first.
std::string RvizConfig(const std::string& usual, const ros_bridge::RunningNode& node);

}  // namespace kinescope::app
