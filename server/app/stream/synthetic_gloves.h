/// Adds generated gloves and props to sources without any: fingers that open and close on the
/// sample's hands, props on the body. World frame, metres. Pure functions, any thread.
#pragma once

#include "core/body_sample.h"

namespace kinescope::app {

/// Adds names and T-pose of the segments that the function below adds, for type 13. Does nothing
/// without a skeleton.
void AddGlovesAndProps(bool gloves, int props, Character& character);

/// Adds poses at `seconds` since the beginning: the 40 finger segments of both hands, scaled to the
/// character's hands (or the default body's), and `props` objects: in the right hand, in the left
/// hand, on the back and at the hip. Segments that the sample has already stay.
/// @pre 0 <= props <= kMaxProps
void AddGlovesAndProps(bool gloves, int props, double seconds, const Character& character,
                       BodySample& sample);

}  // namespace kinescope::app
