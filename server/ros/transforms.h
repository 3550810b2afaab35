/// PersonState -> TF. Pure: no node, no clock.
#pragma once

#include <tf2_msgs/TFMessage.h>

#include <string>

#include "core/scene_state.h"
#include "server/ros/names.h"

namespace kinescope::ros_bridge {

enum class TfShape {
  kFlat,  // reference frame -> every link, as the seed bridge has it
  kTree,  // reference frame -> pelvis, every other link below its parent in the URDF
};

/// One transform for each link of the URDF: first the 23 segments in alphabetical order, then the
/// 44 links without mass inside the joints. Those carry nothing to see, but RViz calls a robot
/// faulty for which it has no transform of every link. Both shapes give every link the same pose.
/// Then gloves and props with the links inside their joints, where the person's model has them: in
/// a tree below their parents in the URDF.
void FillTransforms(const PersonState& person, const PersonNames& names,
                    const std::string& reference_frame, TfShape shape,
                    tf2_msgs::TFMessage& message);

/// Adds the tracked objects of a scene, each `<model>_<its name>` below the reference frame.
void AddObjects(const SceneState& scene, const PersonNames& names,
                const std::string& reference_frame, tf2_msgs::TFMessage& message);

}  // namespace kinescope::ros_bridge
