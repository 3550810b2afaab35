/// Efforts of a robot's joints as rings about them: RViz's Effort. Pure functions, any thread.
#pragma once

#include <sensor_msgs/JointState.h>

#include <functional>
#include <optional>
#include <string>

#include "server/ros/force_input.h"
#include "server/ros/shown_messages.h"
#include "urdf/robot/robot_model.h"

namespace kinescope::ros_bridge {

/// A joint of a robot that is shown.
struct ShownJoint {
  int number = 0;                           // of all joints of all robots that are shown
  const urdf::RobotJoint* joint = nullptr;  // of a robot that outlives it
  std::string frame;                        // of its child
};
/// By its name in the URDF; nullopt: no robot that is shown has it.
using FindJoint = std::function<std::optional<ShownJoint>(const std::string& name)>;

/// A ring and its head about the axis of each revolute joint, which go with its frame: they grow,
/// and turn from magenta to red, up to the joint's largest effort. The other joints, and those
/// whose effort is not finite, have none. `size` of the style: RViz's Scale, 1; `width`: 0.02 m;
/// `frames.hidden`: joints without a ring. Source: rviz/default_plugin/effort_visual.cpp and
/// effort_display.cpp of RViz 1.14, which tilts the ring of an axis that lies askew in its frame.
Taken<ShownMarkers> ToMarkers(const sensor_msgs::JointState& message, const FindJoint& find,
                              const ShownStyle& style);

}  // namespace kinescope::ros_bridge
