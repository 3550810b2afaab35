/// Which way a person faces. Pure functions, any thread.
#pragma once

#include <optional>

#include "urdf/kinematics.h"

namespace kinescope::urdf {

/// How a heading was found.
enum class HeadingRule {
  kUpright,      // from the orientations of pelvis and T8; also of bent and sitting people
  kLyingOnSide,  // the side to which the face looks
  kLyingLevel,   // on the back or the belly: the left side
  kUndefined,    // near a headstand, where no direction is meant
};

struct Heading {
  HeadingRule rule = HeadingRule::kUndefined;
  std::optional<double> rad;  // from the world's x axis about z; empty where undefined
};

/// The direction from which a camera sees a person's front. Bending forward or sideways changes it
/// little.
Heading HeadingOf(const LinkPoses& links);

}  // namespace kinescope::urdf
