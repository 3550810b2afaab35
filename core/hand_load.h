/// Load in the hands of a person, as it is set: by an option, an operator or another program.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

namespace kinescope {

/// Load in the hands of one person. A change is ramped over 0.3 s, so that a grip does not act like
/// an impact.
struct HandLoad {
  /// False: no hand load was set. True with zeros: the hands are known to be empty.
  bool is_known = false;
  std::array<double, 2> mass_kg = {0, 0};  // in one hand alone, by urdf::Side
  double both_kg = 0;                      // held with both hands, which share it
  /// CoM of the load that this hand alone holds, in its link frame, m; absent: at the grip point.
  std::array<std::optional<Eigen::Vector3d>, 2> com_in_hand = {};
  /// CoM of the load in both hands, world, m; absent: midway between them, half the weight each.
  std::optional<Eigen::Vector3d> both_com_in_world = {};
};

inline bool operator==(const HandLoad& a, const HandLoad& b) {
  return a.is_known == b.is_known && a.mass_kg == b.mass_kg && a.both_kg == b.both_kg &&
         a.com_in_hand == b.com_in_hand && a.both_com_in_world == b.both_com_in_world;
}

}  // namespace kinescope
