#pragma once

#include <Eigen/Geometry>

namespace kinescope::urdf {

/// The shortest rotation that takes the direction of `from` to that of `to`, of any lengths above
/// 0; about any axis across where they are opposite. It is Eigen's FromTwoVectors, whose
/// decomposition of that case takes a compiler seconds wherever it is used.
Eigen::Quaterniond TurnBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace kinescope::urdf
