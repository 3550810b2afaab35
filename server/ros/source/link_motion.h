/// The states of the 23 segments in a message of xsens_mvn_ros_msgs/LinkStateArray, which has the
/// velocities and accelerations that TF does not have. Pure functions, any thread.
#pragma once

#include <xsens_mvn_ros_msgs/LinkStateArray.h>

#include <array>
#include <cstdint>

#include "core/body_sample.h"
#include "urdf/segments.h"

namespace kinescope::ros_bridge {

/// By segment; of the message, which must outlive it.
using LinkStatesBySegment = std::array<const xsens_mvn_ros_msgs::LinkState*, urdf::kSegmentCount>;

/// Links are identified by the bare names in their headers; others are skipped. Null if all can be
/// used, else the key of the counter for the message.
const char* FindLinks(const xsens_mvn_ros_msgs::LinkStateArray& message,
                      LinkStatesBySegment& states);

/// That of the array, else (xsens_mvn_ros leaves it empty) that of the pelvis.
std::int64_t StampOf(const xsens_mvn_ros_msgs::LinkStateArray& message,
                     const LinkStatesBySegment& states);

/// Sets velocities and accelerations; values that are zero for all links count as not measured.
void AddMotion(const LinkStatesBySegment& states, BodySample& sample);

}  // namespace kinescope::ros_bridge
