/// Computes joint angles as MVN streams them (type 20): mvn-protocol.md 4.5. Pure function, any
/// thread.
#pragma once

#include <array>

#include "urdf/kinematics.h"

namespace kinescope::subject {

/// Degrees, in MVN's order: x abduction or lateral bending, y internal or axial rotation, z
/// flexion; clinical signs on both sides; zero with arms hanging and palms forward. |x| <= 90.
std::array<Eigen::Vector3d, urdf::kJointCount> StreamedAngles(const urdf::LinkPoses& links);

}  // namespace kinescope::subject
