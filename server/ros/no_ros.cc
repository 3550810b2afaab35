// Implements bridge.h, bag_source.h and graph_source.h for a build without ROS: options and
// arguments work; publishing, subscribing and reading bags are rejected with the reason.
#include <algorithm>
#include <cstring>

#include "core/errors.h"
#include "core/starts_with.h"
#include "server/ros/bag_source.h"
#include "server/ros/bridge.h"
#include "server/ros/graph_source.h"

namespace kinescope::ros_bridge {

// A launch file may still pass remappings; they have no effect here.
void InitRos(int& argc, char** argv, const std::string& /*default_name*/) {
  char** const end = std::stable_partition(argv, argv + argc, [](const char* argument) {
    return std::strstr(argument, ":=") == nullptr;
  });
  argc = static_cast<int>(end - argv);
}

bool BuiltWithRos() { return false; }
std::string MasterUri() { return ""; }
bool MasterIsReachable() { return false; }
std::optional<std::string> PrivateParameter(const std::string& /*name*/) { return std::nullopt; }

std::unique_ptr<RosBridge> MakeRosBridge(const BridgeConfig& /*config*/, RosMode mode) {
  if (mode == RosMode::kOff) return nullptr;
  throw UsageError(
      "this Kinescope was built without ROS: install the ROS packages in packages.txt and "
      "configure with -DKINESCOPE_WITH_ROS=ON, or use --ros=off");
}

std::unique_ptr<Source> OpenBag(const std::string& path) {
  throw SourceError("bag '" + path +
                    "': this Kinescope was built without ROS and cannot read bags: install the ROS "
                    "packages in packages.txt and configure with -DKINESCOPE_WITH_ROS=ON");
}

bool IsGraphUrl(std::string_view url) { return StartsWith(url, "ros:"); }

std::unique_ptr<Source> OpenGraph(const std::string& url) {
  throw SourceError("source '" + url +
                    "': this Kinescope was built without ROS and cannot subscribe to it: install "
                    "the ROS packages in packages.txt and configure with -DKINESCOPE_WITH_ROS=ON");
}

}  // namespace kinescope::ros_bridge
