/// The ground under a person: centre of pressure, and how the feet share the force. Pure functions;
/// world frame, metres, newtons; horizontal points are (x, y). Any thread, no allocation.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "server/loads/inverse_dynamics.h"
#include "urdf/skeleton.h"

namespace kinescope::loads {

struct CenterOfPressure {
  Eigen::Vector2d point = Eigen::Vector2d::Zero();  // on the floor
  double free_moment = 0;                           // N m, about the vertical through `point`
};

/// Where `ground` (about the world's origin) acts on the plane z = `floor_z`, joint-loads.md 2.4.
/// nullopt below a tenth of the weight of `mass_kg`: in flight there is no such point.
std::optional<CenterOfPressure> FindCenterOfPressure(const Wrench& ground, double floor_z,
                                                     double mass_kg);

/// One foot as joint-loads.md 2.6 needs it.
struct FootOnGround {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  // of what touches the floor
  double weight = 0;                                 // 0 in the air .. 1 on the floor
};

/// One foot's part.
struct FootShare {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  // N, on the foot
  Eigen::Vector2d point = Eigen::Vector2d::Zero();
  double free_moment = 0;  // N m
};

/// By urdf::Side. Feet nearer than 5 cm share equally. `right_share` is s', contact weights
/// included.
struct GroundSplit {
  double right_share = 0.5;
  std::array<FootShare, 2> feet;
};

/// joint-loads.md 2.6: the CoP is projected on the line between the feet; both get parallel forces,
/// and an offset of their own that they have in common. Together they are exactly `force` at `cop`,
/// unless the share had to be clamped. @pre a foot has weight > 0
GroundSplit SplitGround(const Eigen::Vector3d& force, const CenterOfPressure& cop,
                        const std::array<FootOnGround, 2>& feet);

}  // namespace kinescope::loads
