#pragma once

#include "core/scene_marker.h"

namespace kinescope::ros_bridge {

/// How markers that stand for a message of another type are drawn.
struct MarkerLook {
  bool is_converted = false;  // they do
  GroundLayer ground = GroundLayer::kNone;
  bool has_thin_lines = false;  // of one pixel
};

}  // namespace kinescope::ros_bridge
