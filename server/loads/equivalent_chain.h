/// Computes the statically equivalent serial chain: one vector per segment, so that the CoM of the
/// body is the pelvis' origin plus the sum of all vectors, each rotated with its segment. The chain
/// contains no masses, so it can be identified on a force plate. Source: S. Cotton, A. Murray, P.
/// Fraisse, IEEE/ASME Trans. Mechatronics 14 (2009) 707; joint-loads.md 3.4. Pure functions; any
/// thread.
#pragma once

#include <Eigen/Core>
#include <array>

#include "urdf/body_parameters.h"
#include "urdf/kinematics.h"

namespace kinescope::loads {

/// m, in link frames.
using EquivalentChain = std::array<Eigen::Vector3d, urdf::kSegmentCount>;

EquivalentChain EquivalentChainOf(const urdf::Skeleton& skeleton, const urdf::BodyParameters& body);

/// CoM, world, m. Uses the orientations and the position of the pelvis only; lengths are those of
/// the chain.
Eigen::Vector3d CenterOfMassOf(const EquivalentChain& chain, const urdf::LinkPoses& links);

}  // namespace kinescope::loads
