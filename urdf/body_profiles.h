/// Dimensions of the smooth body model: cross-sections of a person of kReferenceHeight, metres,
/// estimated from anatomical drawings. Other persons' circumferences are scaled in proportion. Pure
/// functions, any thread.
#pragma once

#include <array>

#include "urdf/loft.h"

namespace kinescope::urdf {

/// Trunk and neck are one profile, so that the outline is continuous across their joints. 0 is at
/// the hips, each joint upwards is the next whole number; 6 is C1. u is forward, v to the left.
const Profile& TrunkProfile();

/// Thigh (0 to 1) and shank (1 to 2). u is forward, v outward.
const Profile& LegProfile();

/// Upper arm (0 to 1) and forearm (1 to 2). u is forward, v outward.
const Profile& ArmProfile();

/// From the body's midline (0) to the shoulder joint (1). u is up, v forward.
const Profile& GirdleProfile();

/// From the wrist (0) over the knuckles to the base of the fingers; 1 is the tip of the middle
/// finger. u is towards the thumb, v the back of the hand.
const Profile& PalmProfile();

struct Finger {
  double base_u, base_at;  // knuckle: across (m, towards the thumb) and along the hand
  double tip_u, tip_at;
  double radius;  // m, at the base
};
extern const std::array<Finger, 4> kDigits;

/// Base (0), middle joint (1) and tip (2) of a finger, in radii at its base.
const Profile& FingerProfile();

/// From C1 (0) to the crown (1), and down to the chin. u is forward, v to the left.
const Profile& HeadProfile();

/// From the lobe (0) to the top (2). u is forward, v away from the head.
const Profile& EarProfile();

/// Along the sole from the back of the heel (0) to the ball (1). u is up, v outward; the underside
/// is flat.
const Profile& FootProfile();

/// From the ball (0) to the tip (1). u is up, v outward; the underside is flat.
const Profile& ToeProfile();

/// Forward offset of the face at (y, z), in lengths of the head from C1 to the crown: nose, brow,
/// eyes, lips and chin.
double FaceRelief(double y, double z);

/// Offset of the trunk surface from its profile, m forward and backward, at y (m to the left) and
/// `at` (as in TrunkProfile): chest, groove of the spine, shoulder blades, buttocks.
struct TrunkRelief {
  double front = 0, back = 0;
};
TrunkRelief TrunkReliefAt(double y, double at);

}  // namespace kinescope::urdf
