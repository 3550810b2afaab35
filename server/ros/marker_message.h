/// A message of a marker (visualization_msgs/Marker) as a SceneMarker. What RViz draws in spite of
/// a defect is drawn, too. Pure functions; any thread.
#pragma once

#include <visualization_msgs/Marker.h>

#include <string>

#include "core/scene_marker.h"
#include "server/ros/refusal.h"

namespace kinescope::ros_bridge {

inline constexpr std::size_t kLongestMarkerName = 256;  // bytes, of a frame or a namespace

/// The shape only, in the frame of the message. A quaternion of zeros is no rotation; any other is
/// normalised. Points, colours and texts are dropped for types that do not use them. As in RViz:
/// colours beyond 0 to 1 are clamped, points that are not finite are left out, a size below 0 is
/// one above, and what is flat has a thickness. A text that is too long is shortened; of more than
/// kMaxMarkerPoints points, as many are taken throughout.
Taken<SceneMarker> ToSceneMarker(const visualization_msgs::Marker& message);

/// As of ToSceneMarker.
Eigen::Vector4d ColorOf(const std_msgs::ColorRGBA& color);

/// Whether `points` of a message belong to such a marker.
bool HasPoints(MarkerType type);

/// "marker walls/3: <why>".
Refusal RefusalOf(const char* kind, const visualization_msgs::Marker& message,
                  const std::string& why);

}  // namespace kinescope::ros_bridge
