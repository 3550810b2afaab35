/// Postures in which a simplified skin must look like the whole one. Pure functions, any thread.
#pragma once

#include <vector>

#include "urdf/kinematics.h"
#include "urdf/skeleton.h"

namespace kinescope::render {

/// The first is of work, in which all large joints are bent: what is round there needs triangles,
/// though it may be flat in the bind pose. The others are those at the ends of the joints' ranges,
/// with arms and legs straight or folded.
std::vector<urdf::LinkPoses> SeenPoses(const urdf::Skeleton& skeleton);

}  // namespace kinescope::render
