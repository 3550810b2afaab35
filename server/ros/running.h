/// The Kinescope nodes that run in the ROS graph: what each tells the master about itself in its
/// parameter `~published`, for programs that show it.
#pragma once

#include <string>
#include <vector>

namespace kinescope::ros_bridge {

/// A person whom a node publishes.
struct RunningPerson {
  std::string model;        // prefix of links and frames: "skeleton"
  std::string description;  // parameter with the URDF: "/robot_description"
  std::string topics;       // before the names of topics: "/kinescope/", "/kinescope/anna/"
};

struct RunningNode {
  std::string name;             // "/kinescope"
  std::string reference_frame;  // "world"
  bool has_frames = false;      // it publishes the people's TF frames
  bool has_view = false;        // `~view/image_raw` is there
  std::vector<RunningPerson> people;
};

/// By name. Only nodes whose topics are registered, so none that has ended.
/// @throws UsageError without a master or the module, or in a build without ROS.
std::vector<RunningNode> FindRunningNodes();

/// "/lab/kinescope" for "kinescope" in the namespace "lab" of this program.
/// @throws UsageError if it is no name
std::string FullNodeName(const std::string& name);

/// Of a node with the name of this one, which the master ends once this one registers: it may be
/// the one that was wanted. Asks for half a second at most; call it before that.
void WarnOfNamesake();

}  // namespace kinescope::ros_bridge
