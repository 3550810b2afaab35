/// Converts PersonState to TF. Pure: no node, no clock; any thread.
#pragma once

#include <tf2_msgs/TFMessage.h>

#include <string>

#include "core/scene_state.h"
#include "server/ros/names.h"

namespace kinescope::ros_bridge {

enum class TfShape {
  kFlat,  // reference frame -> every link, as in xsens_mvn_ros
  kTree,  // reference frame -> pelvis; every other link is a child of its parent in the URDF
  kBase,  // reference frame -> pelvis alone; robot_state_publisher makes the rest
};

/// One transform per link of the URDF: first the 23 segments in alphabetical order, then the 44
/// massless links inside the joints. These have no shape, but RViz reports an error for a robot
/// without a transform of every link. The first two forms give every link the same pose. Then
/// gloves and props with the links inside their joints, if the person's model has them; in a tree
/// as children of their parents in the URDF.
void FillTransforms(const PersonState& person, const PersonNames& names,
                    const std::string& reference_frame, TfShape shape,
                    tf2_msgs::TFMessage& message);

/// The 44 massless links inside the joints alone, each a child of the reference frame: what is
/// missing where another node publishes the 23 segments.
void FillInnerTransforms(const PersonState& person, const PersonNames& names,
                         const std::string& reference_frame, tf2_msgs::TFMessage& message);

/// Adds the tracked objects of a scene, each as `<model>_<its name>`, a child of the reference
/// frame.
void AddObjects(const SceneState& scene, const PersonNames& names,
                const std::string& reference_frame, tf2_msgs::TFMessage& message);

}  // namespace kinescope::ros_bridge
