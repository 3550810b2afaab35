/// A configuration of RViz for what a node publishes. Pure function, any thread.
#pragma once

#include <string>

#include "server/ros/running.h"

namespace kinescope::app {

/// `usual` (launch/kinescope.rviz) with the displays, topics and frames of `node`: a robot model
/// and markers for each person. The camera follows the first. `with_view`: and the rendered view,
/// if there is one; RViz subscribes to it even while the display is off, so that it is rendered.
std::string RvizConfig(const std::string& usual, const ros_bridge::RunningNode& node,
                       bool with_view = false);

}  // namespace kinescope::app
