/// Converts PersonState to link states, centre of mass and centre of pressure. Pure: no node, no
/// clock; any thread.
#pragma once

#include <geometry_msgs/PointStamped.h>
#include <xsens_mvn_ros_msgs/LinkStateArray.h>

#include <string>

#include "core/scene_state.h"

namespace kinescope::ros_bridge {

/// All 23 links in alphabetical order; pose, twist and acceleration in the reference frame, m and
/// rad. As in xsens_mvn_ros, an element's header.frame_id is the bare name of its link. Velocities
/// that were not measured are zero, because the type has no other value for that.
void FillLinkStates(const PersonState& person, const std::string& reference_frame,
                    xsens_mvn_ros_msgs::LinkStateArray& message);

/// `point`, in the reference frame, m, with the stamp of the sample.
void FillPoint(const PersonState& person, const std::string& reference_frame,
               const Eigen::Vector3d& point, geometry_msgs::PointStamped& message);

}  // namespace kinescope::ros_bridge
