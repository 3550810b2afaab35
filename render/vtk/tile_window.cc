#include "render/vtk/tile_window.h"

#include <GL/glew.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLState.h>
#include <vtkRenderer.h>
#include <vtkTextureObject.h>

#include <algorithm>
#include <cstddef>

#include "render/vtk/pixel_reader.h"
#include "render/vtk/unshown_window.h"

namespace kinescope::render {
namespace {

constexpr int kStripRows = 64;                 // px
constexpr std::size_t kBandPixels = 1U << 16;  // stay in the second-level cache

// Each pixel `factor` times in each direction.
void Enlarge(const std::uint32_t* from, int width, int factor, std::uint32_t* to) {
  if (factor == 2) {
    for (int x = 0; x < width; ++x) to[2 * x] = to[2 * x + 1] = from[x];
  } else {
    for (int x = 0; x < width; ++x) to = std::fill_n(to, factor, from[x]);
  }
}

}  // namespace

TileWindow::TileWindow(UnshownWindow* window, vtkRenderer* floor, vtkRenderer* people)
    : window_(window), floor_(floor), people_(people) {
  floor_->EraseOff();  // DrawFloor() does it
}

TileWindow::~TileWindow() {
  Release(far_);
  Release(small_);
}

void TileWindow::Begin(int width, int height, int supersample) {
  width_ = width;
  height_ = height;
  supersample_ = supersample;
  size_.Need(width * supersample, height * supersample);
  if (supersample > 1) small_size_.Need(width, height);
  window_->SetSize(size_.width(), size_.height());
  window_->GetRenderFramebuffer()->Resize(size_.width(), size_.height());  // if it is not
  const double right = 1.0 * width / size_.width(), top = 1.0 * height / size_.height();
  floor_->SetViewport(0, 0, right, top);
  people_->SetViewport(0, 0, supersample * right, supersample * top);
  is_depth_cleared_ = false;
}

unsigned TileWindow::framebuffer() const { return window_->framebuffer(); }

unsigned TileWindow::floor_framebuffer() const {
  return supersample_ == 1 ? framebuffer() : small_.framebuffer;
}

void TileWindow::DrawFloor() {
  vtkOpenGLState* state = window_->GetState();
  state->PushFramebufferBindings();
  if (supersample_ > 1) Reserve(small_size_.width(), small_size_.height(), false, small_);
  state->vtkglBindFramebuffer(GL_DRAW_FRAMEBUFFER, floor_framebuffer());
  // All of it: llvmpipe draws a rectangle where a part is to be cleared, which takes as long as a
  // third of the floor.
  const vtkOpenGLState::ScopedglEnableDisable scissor(state, GL_SCISSOR_TEST);
  state->vtkglDisable(GL_SCISSOR_TEST);
  const double* const color = floor_->GetBackground();
  state->vtkglClearColor(static_cast<float>(color[0]), static_cast<float>(color[1]),
                         static_cast<float>(color[2]), 1);
  state->vtkglClear(GL_COLOR_BUFFER_BIT);
  state->PopFramebufferBindings();
  floor_->DrawOn();
  people_->DrawOff();
  window_->SetTarget(floor_framebuffer());
  window_->Render();
  window_->SetTarget(0);
}

void TileWindow::DrawPeople() {
  floor_->DrawOff();
  people_->DrawOn();
  people_->SetPreserveDepthBuffer(is_depth_cleared_);
  window_->Render();
}

void TileWindow::PutFloor(const Image& image, const Tile& tile, const std::vector<Tile>& parts) {
  vtkOpenGLState* state = window_->GetState();
  const vtkOpenGLState::ScopedglEnableDisable scissor(state, GL_SCISSOR_TEST);
  state->vtkglDisable(GL_SCISSOR_TEST);
  state->PushFramebufferBindings();
  Reserve(size_.width(), kStripRows, true, far_);
  for (const Tile& part : parts) ClearDepth(Drawn(part, tile, supersample_));
  state->PopFramebufferBindings();
  is_depth_cleared_ = true;
  glBindTexture(GL_TEXTURE_2D, WindowTexture());
  for (const Tile& part : parts) Upload(image, tile, part, supersample_);
  glBindTexture(GL_TEXTURE_2D, 0);
}

void TileWindow::ReplaceFloor(const Image& image, const Tile& tile) {
  glBindTexture(GL_TEXTURE_2D, supersample_ == 1 ? WindowTexture() : small_.color);
  Upload(image, tile, tile, 1);
  glBindTexture(GL_TEXTURE_2D, 0);
}

unsigned TileWindow::WindowTexture() const {
  return window_->GetRenderFramebuffer()->GetColorAttachmentAsTextureObject(0)->GetHandle();
}

// By hand: Mesa's llvmpipe takes several times as long to enlarge, and copies within GL are no
// faster than from here.
void TileWindow::Upload(const Image& image, const Tile& tile, const Tile& part, int scale) {
  const int large_width = part.width * scale;
  const auto line = static_cast<std::size_t>(large_width);
  const int most = static_cast<int>(kBandPixels / (line * static_cast<std::size_t>(scale)));
  const int band = std::clamp(most, 1, part.height);  // rows of the picture
  band_.resize(line * static_cast<std::size_t>(band * scale));
  const auto* const pixels = reinterpret_cast<const std::uint32_t*>(image.rgba.data());
  for (int end = part.y + part.height; end > part.y; end -= band) {
    const int first = std::max(part.y, end - band);
    std::uint32_t* to = band_.data();
    for (int y = end - 1; y >= first; --y) {  // from below, as GL's rows
      Enlarge(pixels + static_cast<std::ptrdiff_t>(y) * image.width + part.x, part.width, scale,
              to);
      for (int copy = 1; copy < scale; ++copy) std::copy_n(to, line, to + line * copy);
      to += line * static_cast<std::size_t>(scale);
    }
    const Tile at = Drawn({part.x, first, part.width, end - first}, tile, scale);
    glTexSubImage2D(GL_TEXTURE_2D, 0, at.x, at.y, at.width, at.height, GL_RGBA, GL_UNSIGNED_BYTE,
                    band_.data());
  }
}

// By copies: glClear() of llvmpipe clears all, which takes a twelfth of a picture, or draws the
// part.
void TileWindow::ClearDepth(const Tile& part) {
  vtkOpenGLState* state = window_->GetState();
  state->vtkglBindFramebuffer(GL_READ_FRAMEBUFFER, far_.framebuffer);
  state->vtkglBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer());
  for (int y = 0; y < part.height; y += kStripRows) {
    const int rows = std::min(kStripRows, part.height - y), bottom = part.y + y;
    glBlitFramebuffer(0, 0, part.width, rows, part.x, bottom, part.x + part.width, bottom + rows,
                      GL_DEPTH_BUFFER_BIT, GL_NEAREST);
  }
}

void TileWindow::EnlargeFloor() {
  if (supersample_ == 1) return;
  vtkOpenGLState* state = window_->GetState();
  const vtkOpenGLState::ScopedglEnableDisable scissor(state, GL_SCISSOR_TEST);
  state->vtkglDisable(GL_SCISSOR_TEST);
  state->PushFramebufferBindings();
  state->vtkglBindFramebuffer(GL_READ_FRAMEBUFFER, small_.framebuffer);
  state->vtkglBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer());
  glBlitFramebuffer(0, 0, width_, height_, 0, 0, supersample_ * width_, supersample_ * height_,
                    GL_COLOR_BUFFER_BIT, GL_NEAREST);
  state->PopFramebufferBindings();
}

void TileWindow::Reserve(int width, int height, bool has_depth, Target& target) {
  if (target.color != 0 && width == target.width && height == target.height) return;
  Release(target);
  target.width = width;
  target.height = height;
  glGenFramebuffers(1, &target.framebuffer);
  window_->GetState()->vtkglBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer);
  AddColor(target);
  if (has_depth) AddDepth(target);
}

// To the target that is bound.
void TileWindow::AddColor(Target& target) {
  glGenTextures(1, &target.color);
  glBindTexture(GL_TEXTURE_2D, target.color);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, target.width, target.height, 0, GL_RGBA,
               GL_UNSIGNED_BYTE, nullptr);
  glBindTexture(GL_TEXTURE_2D, 0);
  glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target.color, 0);
}

// To the target that is bound; of the window's format, so that it can be copied.
void TileWindow::AddDepth(Target& target) {
  vtkOpenGLState* state = window_->GetState();
  glGenTextures(1, &target.depth);
  glBindTexture(GL_TEXTURE_2D, target.depth);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32, target.width, target.height, 0,
               GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, nullptr);
  glBindTexture(GL_TEXTURE_2D, 0);
  glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, target.depth, 0);
  const vtkOpenGLState::ScopedglDepthMask mask(state);
  state->vtkglDepthMask(GL_TRUE);
  state->vtkglClearDepth(1);
  glClear(GL_DEPTH_BUFFER_BIT);
}

void TileWindow::Release(Target& target) {
  if (target.framebuffer == 0) return;
  glDeleteFramebuffers(1, &target.framebuffer);
  glDeleteTextures(1, &target.color);
  if (target.depth != 0) glDeleteTextures(1, &target.depth);
  target = Target();
}

}  // namespace kinescope::render
