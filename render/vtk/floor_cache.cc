#include "render/vtk/floor_cache.h"

#include <GL/glew.h>
#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtkRenderer.h>

#include <algorithm>

namespace kinescope::render {
namespace {

constexpr int kStripRows = 64;  // px

}  // namespace

FloorCache::FloorCache(vtkOpenGLRenderWindow* window, vtkRenderer* floor, vtkRenderer* people)
    : window_(window), floor_(floor), people_(people) {
  on_start_->SetCallback(OnPeopleStart);
  on_start_->SetClientData(this);
  people_->PreserveDepthBufferOn();  // PutFloor clears it
  observer_ = people_->AddObserver(vtkCommand::StartEvent, on_start_);
}

FloorCache::~FloorCache() {
  people_->RemoveObserver(observer_);
  Release(picture_);
  Release(full_);
  Release(far_);
}

void FloorCache::Prepare(const Key& key, int supersample, const std::vector<Tile>& parts) {
  // Kept from the second picture on: a camera that moves should not pay for copies.
  const bool is_same = key == key_;
  is_kept_ = is_kept_ && is_same;
  step_ = !is_same ? Step::kDraw : is_kept_ ? Step::kReuse : Step::kDrawAndKeep;
  key_ = key;
  supersample_ = supersample;
  parts_ = parts;
  floor_->SetDraw(step_ != Step::kReuse);
  floor_->SetViewport(0, 0, 1.0 / supersample, 1.0 / supersample);
}

unsigned FloorCache::framebuffer() const {
  if (supersample_ > 1) return picture_.framebuffer;
  return is_kept_ ? full_.framebuffer : 0;
}

void FloorCache::OnPeopleStart(vtkObject*, unsigned long, void* self, void*) {
  static_cast<FloorCache*>(self)->PutFloor();
}

// Called when the floor has been drawn, or would have been, and the people have not.
void FloorCache::PutFloor() {
  const int* size = window_->GetSize();
  const Tile whole{0, 0, size[0], size[1]};
  const unsigned window = window_->GetRenderFramebuffer()->GetFBOIndex();
  vtkOpenGLState* state = window_->GetState();
  const vtkOpenGLState::ScopedglEnableDisable scissor(state, GL_SCISSOR_TEST);
  state->vtkglDisable(GL_SCISSOR_TEST);
  state->PushFramebufferBindings();
  const int scale = supersample_;
  const bool is_larger = scale > 1;
  if (step_ != Step::kReuse && is_larger) {
    const Tile picture{0, 0, whole.width / scale, whole.height / scale};
    Allocate(picture.width, picture.height, false, picture_);
    Copy(window, 1, picture_.framebuffer, picture);
  }
  Allocate(whole.width, kStripRows, true, far_);
  if (step_ == Step::kDrawAndKeep) {
    Allocate(whole.width, whole.height, false, full_);
    Copy(is_larger ? picture_.framebuffer : window, scale, full_.framebuffer, whole);
    is_kept_ = true;
  }
  for (const Tile& part : parts_) {
    ClearDepth(window, part);
    if (is_kept_) {
      Copy(full_.framebuffer, 1, window, part);
    } else if (is_larger) {
      Copy(picture_.framebuffer, scale, window, part);
    }
  }
  state->PopFramebufferBindings();
}

// `part`: of the target, which is `smaller` times as large.
void FloorCache::Copy(unsigned from, int smaller, unsigned to, const Tile& part) {
  vtkOpenGLState* state = window_->GetState();
  state->vtkglBindFramebuffer(GL_READ_FRAMEBUFFER, from);
  state->vtkglBindFramebuffer(GL_DRAW_FRAMEBUFFER, to);
  const int right = part.x + part.width, top = part.y + part.height;
  glBlitFramebuffer(part.x / smaller, part.y / smaller, right / smaller, top / smaller, part.x,
                    part.y, right, top, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

// By copies: glClear() of llvmpipe clears all, which takes a twelfth of a picture, or draws the
// part.
void FloorCache::ClearDepth(unsigned of, const Tile& part) {
  vtkOpenGLState* state = window_->GetState();
  state->vtkglBindFramebuffer(GL_READ_FRAMEBUFFER, far_.framebuffer);
  state->vtkglBindFramebuffer(GL_DRAW_FRAMEBUFFER, of);
  for (int y = 0; y < part.height; y += kStripRows) {
    const int rows = std::min(kStripRows, part.height - y), bottom = part.y + y;
    glBlitFramebuffer(0, 0, part.width, rows, part.x, bottom, part.x + part.width, bottom + rows,
                      GL_DEPTH_BUFFER_BIT, GL_NEAREST);
  }
}

void FloorCache::Allocate(int width, int height, bool has_depth, Target& target) {
  if (target.texture != 0 && width == target.width && height == target.height) return;
  Release(target);
  vtkOpenGLState* state = window_->GetState();
  glGenTextures(1, &target.texture);
  glBindTexture(GL_TEXTURE_2D, target.texture);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  glBindTexture(GL_TEXTURE_2D, 0);
  glGenFramebuffers(1, &target.framebuffer);
  state->vtkglBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer);
  glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target.texture,
                         0);
  if (has_depth) AddDepth(width, height, target);
  target.width = width;
  target.height = height;
}

// Of the window's format, so that it can be copied. The target is bound.
void FloorCache::AddDepth(int width, int height, Target& target) {
  vtkOpenGLState* state = window_->GetState();
  glGenTextures(1, &target.depth);
  glBindTexture(GL_TEXTURE_2D, target.depth);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32, width, height, 0, GL_DEPTH_COMPONENT,
               GL_UNSIGNED_INT, nullptr);
  glBindTexture(GL_TEXTURE_2D, 0);
  glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, target.depth, 0);
  const vtkOpenGLState::ScopedglDepthMask mask(state);
  state->vtkglDepthMask(GL_TRUE);
  state->vtkglClearDepth(1);
  glClear(GL_DEPTH_BUFFER_BIT);
}

void FloorCache::Release(Target& target) {
  if (target.texture == 0) return;
  glDeleteFramebuffers(1, &target.framebuffer);
  glDeleteTextures(1, &target.texture);
  if (target.depth != 0) glDeleteTextures(1, &target.depth);
  target = Target();
}

}  // namespace kinescope::render
