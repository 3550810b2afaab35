/// What a held load looks like, the same in picture, RViz and page: a dumb-bell in the fist, an
/// iron at the end of a rod where the load's centre lies elsewhere, a box between two hands. Grows
/// with the mass, so that 2 kg and 20 kg are told apart. Pure functions; any thread; no allocation.
#pragma once

#include <array>
#include <cstddef>

#include "core/palette.h"
#include "core/scene_state.h"
#include "urdf/kinematics.h"

namespace kinescope {

inline constexpr Rgb kHeldColor = {0.23, 0.26, 0.31};

/// As a URDF's: a cylinder's axis is z.
struct HeldSolid {
  enum class Kind { kBox = 0, kCylinder = 1 };
  Kind kind = Kind::kBox;
  urdf::Pose pose;                                 // world_from_solid
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  // m: edges; or radius, radius, length
};

/// A bar with two discs in each hand, and one box.
inline constexpr std::size_t kMostHeldSolids = 7;

struct HeldSolids {
  std::array<HeldSolid, kMostHeldSolids> solids{};
  std::size_t count = 0;
};

/// Of what `person` holds now; ramps included, so a load that is gripped grows. Nothing for a hand
/// whose tool is seen as it is (urdf::HumanModel::tools).
HeldSolids HeldBy(const PersonState& person);

}  // namespace kinescope
