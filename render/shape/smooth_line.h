/// Lines on a surface, as calm as a hand draws them. Pure functions, any thread.
#pragma once

#include "render/shape/line_chain.h"

namespace kinescope::render {

/// m
double LengthOf(const SurfaceLine& line);

/// `line` with half of its waves of length `wave`, m, less of shorter and more of longer ones. The
/// ends of an open line stay.
SurfaceLine Smoothed(const SurfaceLine& line, double wave);

}  // namespace kinescope::render
