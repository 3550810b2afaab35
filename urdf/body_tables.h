/// The published tables behind MakeBodyParameters (body_parameters.h), evaluated for one skeleton.
/// The shares still have to be divided by their sum. Pure functions; any thread.
#pragma once

#include <Eigen/Core>
#include <array>

#include "urdf/body_parameters.h"

namespace kinescope::urdf {

struct SegmentShare {
  double mass = 0;                                            // share of the body mass, any unit
  Eigen::Vector3d com_in_link = Eigen::Vector3d::Zero();      // m
  Eigen::Matrix3d inertia_by_mass = Eigen::Matrix3d::Zero();  // about the CoM, m^2, link axes
};
using BodyShares = std::array<SegmentShare, kSegmentCount>;

/// de Leva 1996; joint-loads.md 1.5.
BodyShares DeLevaShares(Sex sex, const Skeleton& skeleton);
/// Winter (Dempster); joint-loads.md 1.3.
BodyShares WinterShares(Sex sex, const Skeleton& skeleton);
/// Dumas et al. 2007 and 2015; joint-loads.md 1.2.
BodyShares DumasShares(Sex sex, const Skeleton& skeleton);
/// The table of URDF generators for MVN subjects; joint-loads.md 1.4.
BodyShares IitShares(const Skeleton& skeleton);

/// CoM of the foot without its toes, in the foot's link frame, m, so that both together have their
/// CoM at `whole_com_in_foot`. In every table the toe segment has a tenth of the foot's mass
/// (joint-loads.md 1.5).
Eigen::Vector3d FootComWithoutToes(const Eigen::Vector3d& whole_com_in_foot,
                                   const Eigen::Vector3d& toe_com_in_toe,
                                   const Eigen::Vector3d& toe_in_foot);
constexpr double kToeShareOfFoot = 0.1;

}  // namespace kinescope::urdf
