/// Describes a camera as a pinhole camera, as calibrations of robot vision do. Pure, any thread.
#pragma once

#include "render/camera/camera.h"
#include "urdf/kinematics.h"

namespace kinescope::app {

/// The axes follow REP 103: z forward, x to the right, y down.
struct Pinhole {
  urdf::Pose world_from_optical;
  double focal_px = 0;  // the axis is in the middle of the picture
};

/// @pre !camera.is_orthographic()
Pinhole PinholeOf(const render::Camera& camera, int height_px);

}  // namespace kinescope::app
