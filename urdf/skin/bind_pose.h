/// The pose in which the body's surface is modelled: half way to what the joints will do, arms 42
/// degrees and legs 9 degrees out, fingers slightly bent. Pelvis at the origin, x forward, z up.
/// Pure functions, any thread.
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "urdf/hand.h"
#include "urdf/kinematics.h"
#include "urdf/skeleton.h"

namespace kinescope::skin {

/// Both hands by urdf::Side.
struct BindPose {
  urdf::LinkPoses links{};
  std::array<urdf::FingerPoses, 2> fingers{};
};

/// Of a person with these lengths. `hands`: their gloved hands, else those of an average adult.
BindPose BindPoseOf(const urdf::Skeleton& skeleton,
                    const std::array<const urdf::HandSkeleton*, 2>& hands = {});

/// A point of the world in the frame of `link`.
inline Eigen::Vector3d InLink(const urdf::Pose& link, const Eigen::Vector3d& p) {
  return link.orientation.conjugate() * (p - link.position);
}

}  // namespace kinescope::skin
