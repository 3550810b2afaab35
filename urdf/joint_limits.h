/// What a person's joints can do: range, strength and speed, for the <limit> elements of the URDF.
/// Wide on purpose: a limit here must never refuse what a living person does. Pure functions.
#pragma once

#include "urdf/segments.h"

namespace kinescope::urdf {

struct AxisLimit {
  double lower = 0, upper = 0;  // rad
  double effort = 0;            // N m
  double velocity = 0;          // rad/s
};

/// Of the turn about one axis of a joint of the body; axis 0 1 2 = x y z of its links, as chained
/// by kinematics.h.
AxisLimit LimitOf(int joint, int axis);

enum class FingerJoint { kCarpus, kPalm, kThumbBase, kKnuckle, kMiddle, kEnd };

/// Likewise of a joint inside the hand, on one side. Fingers bend about x.
AxisLimit LimitOf(FingerJoint joint, bool is_left, int axis);

}  // namespace kinescope::urdf
