/// Where the robots and the markers of a scene are, so that a camera can show it without a person.
/// Pure functions, any thread.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/robot_state.h"
#include "core/scene_marker.h"

namespace kinescope {

/// World frame, m. All of the robots, and of the markers what is near them. Without a robot, most
/// of what the markers show: a few points that are far away, as laser scanners have them, would
/// make all else too small to see. Empty: nothing has a place.
[[nodiscard]] Eigen::AlignedBox3d ExtentOf(const std::vector<RobotState>& robots,
                                           const MarkerList& markers);

/// Holds an extent while what is shown moves: it becomes larger where something leaves it, and
/// smaller if much less is there. One thread.
class HeldExtent {
 public:
  /// `now`: an empty box changes nothing.
  const Eigen::AlignedBox3d& Follow(const Eigen::AlignedBox3d& now);

 private:
  Eigen::AlignedBox3d held_;
};

}  // namespace kinescope
