/// Shape of a hand load, identical in pictures, RViz and the page: a dumb-bell in the fist, an iron
/// at the end of a rod if the load's CoM lies elsewhere, a box between two hands. The size grows
/// with the mass, so that 2 kg and 20 kg can be distinguished. Pure functions; any thread; no
/// allocation.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "core/palette.h"
#include "core/scene_state.h"
#include "urdf/kinematics.h"

namespace kinescope {

inline constexpr Rgb kHandLoadColor = {0.23, 0.26, 0.31};

/// A solid as in a URDF: the axis of a cylinder is z.
struct HandLoadSolid {
  enum class Kind { kBox = 0, kCylinder = 1 };
  Kind kind = Kind::kBox;
  urdf::Pose pose;                                 // world_from_solid
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  // m: edges; or radius, radius, length
  std::optional<urdf::Side> hand = {};             // nullopt: both
};

/// A bar with two discs in each hand, and one box.
inline constexpr std::size_t kMaxHandLoadSolids = 7;

struct HandLoadShape {
  std::array<HandLoadSolid, kMaxHandLoadSolids> solids{};
  std::size_t count = 0;
};

/// The solids of the current hand load of `person`, ramps included: a load that is being gripped
/// grows. A hand with a visible tool (urdf::HumanModel::tools) gets none.
HandLoadShape ShapeOfHandLoad(const PersonState& person);

}  // namespace kinescope
