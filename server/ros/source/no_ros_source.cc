// Implements bag_source.h and graph_source.h for a build without ROS: reading bags and subscribing
// are rejected with the reason.
#include "core/system/errors.h"
#include "core/system/starts_with.h"
#include "server/ros/source/bag_source.h"
#include "server/ros/source/graph_source.h"

namespace kinescope::ros_bridge {

std::unique_ptr<Source> OpenBag(const std::string& path, const GraphView& /*view*/) {
  throw SourceError("bag '" + path +
                    "': this Kinescope was built without ROS and cannot read bags: install the ROS "
                    "packages in packages.txt and configure with -DKINESCOPE_WITH_ROS=ON");
}

bool IsGraphUrl(std::string_view url) { return StartsWith(url, "ros:"); }

std::unique_ptr<Source> OpenGraph(const std::string& url, const GraphView& /*view*/) {
  throw SourceError("source '" + url +
                    "': this Kinescope was built without ROS and cannot subscribe to it: install "
                    "the ROS packages in packages.txt and configure with -DKINESCOPE_WITH_ROS=ON");
}

bool HasMaster(const Source& /*graph*/) { return false; }
std::string MissingInGraph(const Source& /*graph*/) { return ""; }

}  // namespace kinescope::ros_bridge
