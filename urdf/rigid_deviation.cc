#include "urdf/rigid_deviation.h"

#include <algorithm>

namespace kinescope::urdf {

void RigidDeviation::Raise(const RigidDeviation& other) {
  for (std::size_t i = 0; i < position.size(); ++i) {
    position[i] = std::max(position[i], other.position[i]);
    orientation[i] = std::max(orientation[i], other.orientation[i]);
  }
}

double RigidDeviation::LargestPosition() const {
  return *std::max_element(position.begin(), position.end());
}

double RigidDeviation::LargestOrientation() const {
  return *std::max_element(orientation.begin(), orientation.end());
}

RigidDeviation MeasureDeviation(const Skeleton& skeleton, const LinkPoses& measured,
                                const JointAngles& angles) {
  const LinkPoses rigid = ForwardKinematics(skeleton, measured[kPelvis], angles);
  RigidDeviation deviation;
  for (std::size_t i = 1; i < rigid.size(); ++i) {
    deviation.position[i] = (rigid[i].position - measured[i].position).norm();
    deviation.orientation[i] = rigid[i].orientation.angularDistance(measured[i].orientation);
  }
  return deviation;
}

}  // namespace kinescope::urdf
