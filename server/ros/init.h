/// What the command line said about ROS; the functions themselves are in bridge.h.
#pragma once

#include <map>
#include <string>

namespace kinescope::ros_bridge {

/// The private parameters given as `_name:=value`.
const std::map<std::string, std::string>& PrivateArguments();

/// Ends our node, in a bounded time. Whoever started roscpp calls it; the second call does nothing.
void LeaveRos();

}  // namespace kinescope::ros_bridge
