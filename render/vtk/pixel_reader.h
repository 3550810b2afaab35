/// Reads what was drawn into a picture, averages it where it was drawn larger, and turns GL's rows,
/// which begin at the bottom. Use it while the context of the window is current.
#pragma once

#include <cstdint>
#include <vector>

#include "render/image/image.h"
#include "render/image/tile.h"

class vtkOpenGLRenderWindow;

namespace kinescope::render {

/// Where `part` of a picture is in a framebuffer with `tile` of it: px, from below.
Tile Drawn(const Tile& part, const Tile& tile, int supersample);

class PixelReader {
 public:
  /// `window` is borrowed, and has rendered before.
  explicit PixelReader(vtkOpenGLRenderWindow* window);

  /// `framebuffer` (GL's name) has `tile` of the picture, `supersample` times as large. Writes
  /// `part` of it to its place in `image`. @throws RenderError.
  void Read(unsigned framebuffer, const Tile& tile, const Tile& part, int supersample,
            Image& image);
  /// All depths of what the window rendered last, of which it shows `width` x `height` px, from
  /// below.
  std::vector<float> ReadDepth(int width, int height);

 private:
  void ReadPixels(const Tile& from, std::uint8_t* rgba, int row_px);

  vtkOpenGLRenderWindow* const window_;
  const bool can_invert_;  // MESA_pack_invert
  std::vector<std::uint8_t> large_;
};

}  // namespace kinescope::render
