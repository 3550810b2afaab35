// Implements init.h and bridge.h for a build without ROS: options and arguments work; publishing is
// rejected with the reason.
#include <algorithm>
#include <cstring>

#include "core/system/errors.h"
#include "server/ros/bridge.h"
#include "server/ros/running.h"

namespace kinescope::ros_bridge {

// A launch file may still pass remappings; they have no effect here.
void TakeRosArguments(int& argc, char** argv, const std::string& /*default_name*/) {
  char** const end = std::stable_partition(argv, argv + argc, [](const char* argument) {
    return std::strstr(argument, ":=") == nullptr;
  });
  argc = static_cast<int>(end - argv);
}

std::vector<std::string> TakenRosArguments() { return {}; }
bool BuiltWithRos() { return false; }
std::string MasterUri() { return ""; }
bool MasterIsReachable() { return false; }
const std::map<std::string, NodeParameter>& PrivateParameters() {
  static const std::map<std::string, NodeParameter> kNone;
  return kNone;
}

std::vector<RunningNode> FindRunningNodes() {
  throw UsageError(
      "this Kinescope was built without ROS: install the ROS packages in packages.txt and "
      "configure with -DKINESCOPE_WITH_ROS=ON");
}

std::string FullNodeName(const std::string& name) { return name; }

std::unique_ptr<RosBridge> MakeRosBridge(const BridgeConfig& /*config*/, RosMode mode) {
  if (mode == RosMode::kOff) return nullptr;
  throw UsageError(
      "this Kinescope was built without ROS: install the ROS packages in packages.txt and "
      "configure with -DKINESCOPE_WITH_ROS=ON, or use --ros=off");
}

}  // namespace kinescope::ros_bridge
