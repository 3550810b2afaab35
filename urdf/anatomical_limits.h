/// Limits of anatomical angles (anatomical_angles.h), from those of the URDF's joints
/// (joint_limits.h). Pure functions, any thread.
#pragma once

namespace kinescope::urdf {

struct AngleRange {
  double lower = 0, upper = 0;  // deg
};

/// Of one joint about one axis, 0 1 2 = x y z as AnatomicalAngles() has them, while its other two
/// angles are 0. At most 180 deg; about x at most 90 deg, but at the shoulder, where a larger angle
/// is a raised arm.
AngleRange AnatomicalRangeOf(int joint, int axis);

}  // namespace kinescope::urdf
