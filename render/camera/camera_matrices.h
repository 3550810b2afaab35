/// Converts a Camera to OpenGL matrices (GLM), for rendering and projection within render/. Pure
/// functions, any thread.
#pragma once

#include <glm/mat4x4.hpp>

#include "render/camera/camera.h"
#include "render/image/tile.h"

namespace kinescope::render {

/// view_from_world: right-handed, the camera looks along its -z. If `up` is parallel to the view
/// axis, a fixed sideways direction is used.
glm::dmat4 ViewFromWorld(const Camera& camera);

/// clip_from_view of a complete picture with this aspect ratio (width / height).
glm::dmat4 ClipFromView(const Camera& camera, double aspect);

/// Converts clip coordinates of a picture of width_px x height_px to those of one of its tiles, so
/// that a picture larger than a framebuffer can be rendered in parts.
glm::dmat4 TileFromClip(const Tile& tile, int width_px, int height_px);

}  // namespace kinescope::render
