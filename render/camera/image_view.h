/// Draws a scene as the camera of an image sees it. Pure function, any thread.
#pragma once

#include "core/camera_image.h"
#include "render/camera/camera.h"
#include "render/image/tile.h"

namespace kinescope::render {

/// The axis of a Camera is in the middle of its picture, that of a real one is not: the image is a
/// part of a larger picture.
struct ImageView {
  Camera camera;
  int width = 0, height = 0;  // px, of the larger picture
  Tile image;                 // its part; as large as was asked for
};

/// The axis is within half a pixel of where it should be.
/// @pre FindDefect(taken_by) is empty; width_px, height_px > 0: of the image as it is shown
ImageView ViewOf(const ImageCamera& taken_by, int width_px, int height_px);

}  // namespace kinescope::render
