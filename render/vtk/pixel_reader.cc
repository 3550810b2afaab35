#include "render/vtk/pixel_reader.h"

#include <GL/glew.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>

#include <algorithm>
#include <cstddef>
#include <string>

#include "render/image/resample.h"
#include "render/renderer.h"

namespace kinescope::render {
namespace {

constexpr int kBandBytes = 1 << 18;

// `row_px`: from the start of a row to that of the next.
void TurnUpsideDown(std::uint8_t* rgba, int width, int height, int row_px) {
  const std::ptrdiff_t row = 4 * static_cast<std::ptrdiff_t>(row_px);
  std::uint8_t* top = rgba;
  std::uint8_t* bottom = rgba + row * (height - 1);
  for (; top < bottom; top += row, bottom -= row) std::swap_ranges(top, top + 4 * width, bottom);
}

}  // namespace

Tile Drawn(const Tile& part, const Tile& tile, int supersample) {
  return {(part.x - tile.x) * supersample,
          (tile.y + tile.height - part.y - part.height) * supersample, part.width * supersample,
          part.height * supersample};
}

PixelReader::PixelReader(vtkOpenGLRenderWindow* window)
    : window_(window), can_invert_(GLEW_MESA_pack_invert != 0) {}

void PixelReader::Read(unsigned framebuffer, const Tile& tile, const Tile& part, int supersample,
                       Image& image) {
  vtkOpenGLState* gl = window_->GetState();
  gl->PushReadFramebufferBinding();
  gl->vtkglBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  if (supersample == 1) {
    const auto first = 4 * (static_cast<std::ptrdiff_t>(part.y) * image.width + part.x);
    ReadPixels(Drawn(part, tile, 1), image.rgba.data() + first, image.width);
  } else {
    // In bands that stay in the second-level cache until they are averaged, instead of 15 MB at
    // once (tests/bench/README.md).
    const int row_bytes = 4 * part.width * supersample * supersample;  // of the picture's rows
    const int band = std::clamp(kBandBytes / row_bytes, 1, part.height);
    large_.resize(static_cast<std::size_t>(band) * static_cast<std::size_t>(row_bytes));
    for (int y = 0; y < part.height; y += band) {
      const Tile rows{part.x, part.y + y, part.width, std::min(band, part.height - y)};
      ReadPixels(Drawn(rows, tile, supersample), large_.data(), rows.width * supersample);
      AverageInto(large_.data(), rows.width, rows.height, supersample, image, rows.x, rows.y);
    }
  }
  gl->PopReadFramebufferBinding();
}

// Straight from the bound framebuffer into the picture: VTK's own way copies twice, and GL's rows
// start at the bottom, which Mesa turns round while it copies; with other drivers we do.
void PixelReader::ReadPixels(const Tile& from, std::uint8_t* rgba, int row_px) {
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glPixelStorei(GL_PACK_ROW_LENGTH, row_px);
  if (can_invert_) glPixelStorei(GL_PACK_INVERT_MESA, 1);
  glReadPixels(from.x, from.y, from.width, from.height, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
  glPixelStorei(GL_PACK_ROW_LENGTH, 0);
  if (can_invert_) glPixelStorei(GL_PACK_INVERT_MESA, 0);
  const GLenum error = glGetError();
  if (error != GL_NO_ERROR) {
    throw RenderError("OpenGL error " + std::to_string(error) + " while drawing " +
                      std::to_string(from.width) + " x " + std::to_string(from.height) +
                      " px; try a smaller picture");
  }
  if (!can_invert_) TurnUpsideDown(rgba, from.width, from.height, row_px);
}

std::vector<float> PixelReader::ReadDepth(int width, int height) {
  std::vector<float> depth(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  vtkOpenGLState* gl = window_->GetState();
  gl->PushReadFramebufferBinding();
  window_->GetRenderFramebuffer()->Bind(GL_READ_FRAMEBUFFER);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(0, 0, width, height, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
  gl->PopReadFramebufferBinding();
  return depth;
}

}  // namespace kinescope::render
