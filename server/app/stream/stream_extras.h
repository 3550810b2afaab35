/// Gloves and props that are made up, for sources that have none: fingers that open and close on
/// the sample's hands, props on the body. Pure functions, any thread.
#pragma once

#include "core/body_sample.h"

namespace kinescope::app {

/// Names and T-pose of what AddExtras() below adds, for type 13. Nothing without a skeleton.
void AddExtras(bool gloves, int props, Character& character);

/// Poses at `seconds` since the beginning: both hands' 40 finger segments, sized to the
/// character's hands (or the default body's), and `props` things held in the right hand, the left
/// hand, worn on the back and at the hip. What the sample has of its own stays.
/// @pre 0 <= props <= kMostProps
void AddExtras(bool gloves, int props, double seconds, const Character& character,
               BodySample& sample);

}  // namespace kinescope::app
