/// Decodes what cameras of other nodes have sent, in the size in which it is shown. Its bytes are
/// untrusted. Pure functions, any thread.
#pragma once

#include <string>
#include <tl/expected.hpp>

#include "core/camera_image.h"
#include "render/image/image.h"

namespace kinescope::render {

/// Opaque, at most `most_width` x `most_height` px with the image's own proportions, and not larger
/// than it is. Numbers of two and four bytes become grey between their smallest and their largest;
/// Bayer patterns are grey, as in RViz. Or why it cannot be read.
/// @pre most_width, most_height > 0
tl::expected<Image, std::string> DecodeCameraImage(const CameraImage& image, int most_width,
                                                   int most_height);

}  // namespace kinescope::render
