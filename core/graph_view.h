/// What is shown of a ROS graph, or of a bag, beside its people and its markers. No ROS type appears
/// here.
#pragma once

#include <string>
#include <vector>

#include "core/robot_state.h"

namespace kinescope {

/// A robot whose links the transforms of a graph, or of a bag, move.
struct GraphRobot {
  std::string parameter;  // of the parameter server, with the URDF; "": it is in `robot`
  std::string tf_prefix;  // its frames are "<tf_prefix>/<link>"; "": as its links
  RobotState robot = {};  // without a parameter: model, meshes and name; else empty
};

struct GraphView {
  /// Of messages that are shown as markers (server/ros/shown_messages.h): points, poses, paths, ...
  std::vector<std::string> topics;
  std::vector<GraphRobot> robots;

  bool is_empty() const { return topics.empty() && robots.empty(); }
};

}  // namespace kinescope
