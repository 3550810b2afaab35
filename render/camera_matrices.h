/// A Camera as OpenGL matrices (GLM), for those that draw or project. Not for other folders.
#pragma once

#include <glm/mat4x4.hpp>

#include "render/camera.h"
#include "render/tile.h"

namespace kinescope::render {

/// view_from_world: right-handed, the camera looks along its -z. Where `up` is along the view axis
/// any sideways direction is taken, always the same one.
glm::dmat4 ViewFromWorld(const Camera& camera);

/// clip_from_view of a whole picture of this aspect ratio (width / height).
glm::dmat4 ClipFromView(const Camera& camera, double aspect);

/// Turns clip coordinates of a picture of width_px x height_px into those of one tile of it, so
/// that pictures larger than a framebuffer can be drawn piece by piece.
glm::dmat4 TileFromClip(const Tile& tile, int width_px, int height_px);

}  // namespace kinescope::render
