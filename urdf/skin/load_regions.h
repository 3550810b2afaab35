/// Where the load of a joint is shown on the skin: the region around each joint whose load is
/// computed. Pure functions, any thread.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "urdf/segments.h"
#include "urdf/skin/bind_pose.h"
#include "urdf/skin/skin_template.h"

namespace kinescope::skin {

inline constexpr std::size_t kRegions = urdf::kScoredJointCount;
/// Index of the region of `joint` (urdf::Joint); nullopt if its load is not computed.
std::optional<std::size_t> RegionOf(int joint);

/// Of a vertex.
struct LoadRegion {
  std::uint8_t joint = 0;  // index of urdf::kScoredJoints, of the nearest region
  /// How far the vertex is inside of it: 1 in its middle, 0 on its border, -1 at most. Wherever a
  /// triangle's vertices have different joints, all of them are outside.
  float inside = -1;
};

/// Limbs have a band around the joint, shoulders and hips what is within a ball, the trunk a belt.
/// `rest`: positions in the bind pose `bind`, m, of a person of stature `height`, m (0: average).
std::vector<LoadRegion> LoadRegionsOf(const std::vector<Eigen::Vector3f>& rest,
                                      const std::vector<VertexWeights>& weights,
                                      const std::vector<Triangle>& triangles, const BindPose& bind,
                                      double height);

}  // namespace kinescope::skin
