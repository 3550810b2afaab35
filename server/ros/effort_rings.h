/// Efforts of a robot's joints as rings about them: RViz's Effort. Plain values and pure functions.
#pragma once

#include <sensor_msgs/JointState.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>

#include "server/ros/force_input.h"
#include "server/ros/shown_messages.h"
#include "urdf/robot/robot_model.h"

namespace kinescope::ros_bridge {

/// A joint of a robot that is shown.
struct ShownJoint {
  int number = 0;                                 // of all joints of all robots that are shown
  std::shared_ptr<const urdf::RobotJoint> joint;  // never null
  std::string frame;                              // of its child
};

/// The joints of all robots that are shown. Of several with one name, the first counts.
class ShownJoints {
 public:
  void Add(const std::shared_ptr<const urdf::RobotModel>& model, const std::string& tf_prefix);
  /// By its name in the URDF; nullopt: no robot has it.
  std::optional<ShownJoint> Find(const std::string& name) const;

 private:
  std::unordered_map<std::string, ShownJoint> joints_;
};
/// As ShownJoints::Find.
using FindJoint = std::function<std::optional<ShownJoint>(const std::string& name)>;

/// A ring and its head about the axis of each revolute joint, which go with its frame: they grow,
/// and turn from magenta to red, up to the joint's largest effort. The other joints, and those
/// whose effort is not finite, have none. `size` of the style: RViz's Scale, 1; `width`: 0.02 m;
/// `frames.hidden`: joints without a ring. Source: rviz/default_plugin/effort_visual.cpp and
/// effort_display.cpp of RViz 1.14, which tilts the ring of an axis that lies askew in its frame.
Taken<ShownMarkers> ToMarkers(const sensor_msgs::JointState& message, const FindJoint& find,
                              const ShownStyle& style);

}  // namespace kinescope::ros_bridge
