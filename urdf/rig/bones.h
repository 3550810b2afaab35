/// Which bones of a rig are which segments of the body, by the names of VRM, Mixamo or MVN, else by
/// usual ones (UsualName). Pure functions, any thread.
#pragma once

#include <array>
#include <vector>

#include "urdf/rig/rig.h"
#include "urdf/segments.h"

namespace kinescope::rig {

struct Bones {
  /// The node at the joint of each segment; -1: the rig has none. Of a spine with names of its own
  /// (VRM, Mixamo), the bones are T8's.
  std::array<int, urdf::kSegmentCount> node_of{};
  /// The segment that carries what hangs on a node: its own, or that of the nearest ancestor with
  /// one (fingers, hair, twist bones); -1: above the hips.
  std::vector<int> segment_of;
  /// The frame of skin::Frames() of each node, if it was exported from Kinescope; else -1.
  std::vector<int> frame_of;
  std::array<int, 2> middle_finger = {-1, -1};  // its first node, by urdf::Side
  bool has_spine_of_mvn = false;                // L5, L3, T12 and T8
  bool has_frames = false;                      // any of `frame_of`: a skin of Kinescope's
};

/// @throws std::runtime_error with the missing bones, the names that would do, and those found; for
/// two bones of one name.
Bones FindBones(const Rig& rig);

}  // namespace kinescope::rig
