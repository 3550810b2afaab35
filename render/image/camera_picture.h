/// Decodes what cameras of other nodes have sent, in the size in which it is shown. Its bytes are
/// untrusted. Pure functions, any thread.
#pragma once

#include <string>
#include <tl/expected.hpp>

#include "core/camera_image.h"
#include "render/image/image.h"

namespace kinescope::render {

/// Opaque, as large as fits into `width` x `height` px with the image's own proportions: shrunk by
/// averages, or enlarged. Numbers of two and four bytes become grey between their smallest and
/// their largest; Bayer patterns are grey, as in RViz. Or why it cannot be read.
/// @pre width, height > 0
tl::expected<Image, std::string> DecodeCameraImage(const CameraImage& image, int width, int height);

}  // namespace kinescope::render
