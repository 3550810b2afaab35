/// Computes the centre of pressure and how the feet share the ground reaction force. Pure
/// functions; world frame, metres, newtons, N·m; horizontal points are (x, y). Any thread, no
/// allocation.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "server/loads/inverse_dynamics.h"
#include "urdf/skeleton.h"

namespace kinescope::loads {

struct CenterOfPressure {
  Eigen::Vector2d point = Eigen::Vector2d::Zero();  // on the floor, world, m
  double free_moment = 0;                           // N·m, about the vertical through `point`
};

/// Where `ground` (about the world's origin) acts on the plane z = `floor_z`, joint-loads.md 2.4.
/// nullopt if the vertical force is below a tenth of the weight of `mass_kg`: without foot contact
/// there is no such point.
std::optional<CenterOfPressure> FindCenterOfPressure(const Wrench& ground, double floor_z,
                                                     double mass_kg);

/// Contact state of one foot for joint-loads.md 2.6.
struct FootOnGround {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  // of the parts in contact, world, m
  double weight = 0;  // contact weight: 0 without contact .. 1 on the floor
};

/// Share of one foot in the ground reaction force.
struct FootShare {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  // N, on the foot
  Eigen::Vector2d point = Eigen::Vector2d::Zero();
  double free_moment = 0;  // N·m, about the vertical through `point`
};

/// By urdf::Side. Feet less than 5 cm apart share equally. `right_share` is s', contact weights
/// included.
struct GroundSplit {
  double right_share = 0.5;
  std::array<FootShare, 2> feet;
};

/// Splits `force` at `cop`, joint-loads.md 2.6: the CoP is projected on the line between the feet;
/// both feet get parallel forces and the same offset from the line. Together they are exactly
/// `force` at `cop`, unless the share had to be clamped. @pre a foot has weight > 0
GroundSplit SplitGround(const Eigen::Vector3d& force, const CenterOfPressure& cop,
                        const std::array<FootOnGround, 2>& feet);

}  // namespace kinescope::loads
