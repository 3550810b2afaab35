/// Shows where two pictures differ. Pure function, any thread.
#pragma once

#include "render/image/image.h"
#include "render/image/picture_difference.h"

namespace kinescope::render {

/// The expected picture in pale grey; changed pixels in yellow, orange, red and dark purple, the
/// further from their colour the darker; smoothed edges in blue. If the sizes differ, the
/// picture covers both, and is red where only one of them has pixels. Opaque.
Image HeatMap(const Image& expected, const PictureDifference& difference);

}  // namespace kinescope::render
