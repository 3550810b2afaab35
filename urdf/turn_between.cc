#include "urdf/turn_between.h"

namespace kinescope::urdf {

Eigen::Quaterniond TurnBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

}  // namespace kinescope::urdf
