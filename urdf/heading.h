/// Which way a person faces. Pure functions, any thread.
#pragma once

#include <optional>

#include "urdf/kinematics.h"

namespace kinescope::urdf {

/// The direction from which a camera sees a person's front: the angle from the world's x axis about
/// z, rad. From the orientations of pelvis and T8, so that bending forward or sideways changes
/// little. A lying person is seen from the side to which the face looks; on the back or on the
/// belly, from the left. nullopt near a headstand, where no direction is meant.
std::optional<double> HeadingOf(const LinkPoses& links);

}  // namespace kinescope::urdf
