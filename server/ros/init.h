/// The ROS arguments of the command line; the functions for other folders are in bridge.h.
#pragma once

#include <chrono>
#include <map>
#include <string>

namespace kinescope::ros_bridge {

/// Starts roscpp with the arguments of TakeRosArguments, the first time; does not contact a master.
/// Writes no files. @throws UsageError if ROS_MASTER_URI or a name is invalid. Any thread.
void InitRos();

/// The private parameters given as `_name:=value`.
const std::map<std::string, std::string>& PrivateArguments();

/// How long the master may still take to answer at the start of the program, which takes 3 s at
/// most with the question for the node's parameters.
std::chrono::milliseconds StartPatienceLeft();

/// From now on roscpp's calls of the master take a few seconds together and are not repeated. For
/// the end of the program, before it waits for a thread that makes such calls.
void HurryRoscpp();

/// Shuts this node down in a limited time. Called by the object that started roscpp; a second call
/// does nothing.
void LeaveRos();

}  // namespace kinescope::ros_bridge
