/// The limbs as capsules on the links of the body, and which of them cover the skin of which. Pure
/// functions, any thread.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "urdf/skeleton.h"
#include "urdf/skin/occlusion.h"
#include "urdf/skin/skin_template.h"

namespace kinescope::skin {

/// A capsule that moves with the links of its ends.
struct LimbEnd {
  int segment = 0;                                  // urdf::Segment
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // in its link frame, m
  double radius = 0;                                // m
};
struct LimbShape {
  LimbEnd start, end;
};
using LimbShapes = std::array<LimbShape, kLimbs>;
LimbShapes LimbShapesOf(const urdf::Skeleton& skeleton, const Build& build);

/// What a limb does to the skin of a limb.
enum class Covering : std::uint8_t {
  kNone,    // the same one, or their surfaces go over into one another
  kJoined,  // it covers what is away from it: what lies on the one is skin of the other
  kWhole,
};
Covering CoveringOf(Limb skin, Limb by);

Limb LimbOfSegment(int segment);

}  // namespace kinescope::skin
