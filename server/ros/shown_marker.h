/// A marker that a message is shown as, with what visualization_msgs/Marker has no member for.
#pragma once

#include <visualization_msgs/Marker.h>

#include <memory>
#include <utility>
#include <vector>

namespace kinescope::ros_bridge {

/// When the points of a marker were measured, while the sensor may have moved.
struct Sweep {
  double secs = 0;  // from the stamp of the message, when the first one was, to the last
  std::vector<float> shares = {};  // 0..1 of that time, one per point
};

/// Of one message. Ids are the same for each message of a type, so that a message replaces the one
/// before; what it does not show is deleted.
struct ShownMarker : visualization_msgs::Marker {
  ShownMarker() = default;
  ShownMarker(visualization_msgs::Marker marker)  // NOLINT(google-explicit-constructor)
      : visualization_msgs::Marker(std::move(marker)) {}

  std::shared_ptr<const Sweep> sweep;  // null: all at the stamp
};
using ShownMarkers = std::vector<ShownMarker>;

inline std::shared_ptr<const Sweep> SweepOf(const ShownMarker& marker) { return marker.sweep; }
inline std::shared_ptr<const Sweep> SweepOf(const visualization_msgs::Marker&) { return nullptr; }

}  // namespace kinescope::ros_bridge
