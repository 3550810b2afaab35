/// Hangs vertices of a rig on the frames of the skin (urdf/skin/frames.h). A rig bends a joint by
/// mixing two bones; here, a vertex between them turns by its part, so that folds keep their
/// volume, and forearm and thigh twist along their length. Pure functions, any thread.
#pragma once

#include <Eigen/Core>

#include "urdf/rig/bones.h"
#include "urdf/rig/rig.h"
#include "urdf/skin/bind_pose.h"
#include "urdf/skin/skin_template.h"

namespace kinescope::rig {

/// `position`: in `bind`, the bind pose of the reference body.
skin::VertexWeights WeightsOf(const RigVertex& vertex, const Eigen::Vector3d& position,
                              const Bones& bones, const skin::BindPose& bind);

}  // namespace kinescope::rig
