/// The ROS arguments of the command line; the functions for other folders are in bridge.h.
#pragma once

#include <map>
#include <string>

namespace kinescope::ros_bridge {

/// The private parameters given as `_name:=value`.
const std::map<std::string, std::string>& PrivateArguments();

/// Shuts this node down in a limited time. Called by the object that started roscpp; a second call
/// does nothing.
void LeaveRos();

}  // namespace kinescope::ros_bridge
