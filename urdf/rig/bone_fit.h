/// Where each part of a rig goes in the bind pose of the reference body: turned to its bones,
/// stretched along them, and of its girth. Pure functions, any thread.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "urdf/rig/bones.h"
#include "urdf/rig/rig.h"
#include "urdf/segments.h"

namespace kinescope::rig {

/// bind_from_rig, m, by segment. Segments without a bone have that of the trunk.
/// @throws std::runtime_error as SkinOf().
std::array<Eigen::Affine3d, urdf::kSegmentCount> FitBones(const Rig& rig, const Bones& bones);

}  // namespace kinescope::rig
