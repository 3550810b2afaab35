/// The tables behind MakeBodyParameters (body_parameters.h), each for one skeleton: shares that are
/// still to be divided by their sum. Pure functions; any thread.
#pragma once

#include <Eigen/Core>
#include <array>

#include "urdf/body_parameters.h"

namespace kinescope::urdf {

struct SegmentShare {
  double mass = 0;                                            // of the body's, any unit
  Eigen::Vector3d com_in_link = Eigen::Vector3d::Zero();      // m
  Eigen::Matrix3d inertia_by_mass = Eigen::Matrix3d::Zero();  // about the CoM, m^2, link axes
};
using BodyShares = std::array<SegmentShare, kSegmentCount>;

/// joint-loads.md 1.5.
BodyShares DeLevaShares(Sex sex, const Skeleton& skeleton);
/// joint-loads.md 1.3.
BodyShares WinterShares(Sex sex, const Skeleton& skeleton);
/// joint-loads.md 1.2.
BodyShares DumasShares(Sex sex, const Skeleton& skeleton);
/// joint-loads.md 1.4.
BodyShares IitShares(const Skeleton& skeleton);

/// In every table a tenth of the foot's mass is the toe segment's (joint-loads.md 1.5): the CoM of
/// the rest, so that both together have theirs at `whole_com_in_foot`.
Eigen::Vector3d FootComWithoutToes(const Eigen::Vector3d& whole_com_in_foot,
                                   const Eigen::Vector3d& toe_com_in_toe,
                                   const Eigen::Vector3d& toe_in_foot);
constexpr double kToeShareOfFoot = 0.1;

}  // namespace kinescope::urdf
