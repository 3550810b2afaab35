/// Where the load of a joint is shown on the skin: the region around each joint whose load is
/// computed. Pure functions, any thread.
#pragma once

#include <Eigen/Core>
#include <array>
#include <bitset>
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

/// Parts of the body that a region may lie on. A vertex belongs to the one that carries at least
/// kPartWeight (of 255) of it, else to the trunk.
enum class BodyPart : std::uint8_t { kTrunk, kRightArm, kLeftArm, kRightLeg, kLeftLeg };
inline constexpr std::size_t kBodyParts = 5;
inline constexpr int kPartWeight = 230;
/// Of an urdf::Segment.
BodyPart BodyPartOf(int segment);

/// A ball around `middle`, or a band across `direction` through it; in the bind pose, m. How far a
/// point is inside: 1 minus its distance from the middle, in half widths; of a band: the distance
/// along `direction`, less `flare` times the square of how far the point is to the side (y): the
/// border of a collar crosses the top of the shoulders, and does not run along it.
struct RegionShape {
  bool is_ball = false;
  std::bitset<kBodyParts> parts;  // by BodyPart: those it lies on
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  // not always of length 1
  double half_width = 0;
  double flare = 0;  // 1/m
};
/// By place in urdf::kScoredJoints. Limbs have a band around the joint, shoulders and hips a ball,
/// the trunk a belt. `height`: stature, m (0: average).
using RegionShapes = std::array<RegionShape, kRegions>;
RegionShapes RegionShapesOf(const BindPose& bind, double height);

/// Of a vertex.
struct LoadRegion {
  std::uint8_t joint = 0;  // index of urdf::kScoredJoints, of the nearest region
  /// How far the vertex is inside of it: 1 in its middle, 0 on its border, -1 at most. Wherever a
  /// triangle's vertices have different joints, all of them are outside.
  float inside = -1;
};

/// By RegionShapesOf(). `rest`: positions in the bind pose `bind`, m, of a person of stature
/// `height`, m (0: average).
std::vector<LoadRegion> LoadRegionsOf(const std::vector<Eigen::Vector3f>& rest,
                                      const std::vector<VertexWeights>& weights,
                                      const std::vector<Triangle>& triangles, const BindPose& bind,
                                      double height);

}  // namespace kinescope::skin
