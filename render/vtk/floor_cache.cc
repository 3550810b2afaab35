#include "render/vtk/floor_cache.h"

#include <GL/glew.h>
#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtkRenderer.h>

namespace kinescope::render {

FloorCache::FloorCache(vtkOpenGLRenderWindow* window, vtkRenderer* floor, vtkRenderer* people)
    : window_(window), floor_(floor), people_(people) {
  on_start_->SetCallback(OnPeopleStart);
  on_start_->SetClientData(this);
  observer_ = people_->AddObserver(vtkCommand::StartEvent, on_start_);
}

FloorCache::~FloorCache() {
  people_->RemoveObserver(observer_);
  Release();
}

void FloorCache::Prepare(const Key& key) {
  // Kept from the second picture on: a camera that moves should not pay for copies.
  const bool is_same = key == key_;
  is_kept_ = is_kept_ && is_same;
  step_ = !is_same ? Step::kDraw : is_kept_ ? Step::kReuse : Step::kDrawAndKeep;
  key_ = key;
  floor_->SetDraw(step_ != Step::kReuse);
}

void FloorCache::PrepareParts(const std::vector<Tile>& parts) {
  step_ = Step::kReuseParts;
  parts_ = parts;
  floor_->DrawOff();
}

void FloorCache::OnPeopleStart(vtkObject*, unsigned long, void* self, void*) {
  static_cast<FloorCache*>(self)->Copy();
}

// Called when the floor has been drawn, or would have been, and the people have not.
void FloorCache::Copy() {
  if (step_ == Step::kDraw) return;
  if (step_ == Step::kReuseParts) return CopyParts();
  const int* size = window_->GetSize();
  const int width = size[0], height = size[1];
  vtkOpenGLState* state = window_->GetState();
  const vtkOpenGLState::ScopedglEnableDisable scissor(state, GL_SCISSOR_TEST);
  state->vtkglDisable(GL_SCISSOR_TEST);
  state->PushFramebufferBindings();
  if (step_ == Step::kDrawAndKeep) {
    Allocate(width, height);
    window_->GetRenderFramebuffer()->Bind(GL_READ_FRAMEBUFFER);
    state->vtkglBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
    is_kept_ = true;
  } else {
    window_->GetRenderFramebuffer()->Bind(GL_DRAW_FRAMEBUFFER);
    state->vtkglBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  }
  glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  state->PopFramebufferBindings();
}

void FloorCache::CopyParts() {
  vtkOpenGLState* state = window_->GetState();
  const vtkOpenGLState::ScopedglEnableDisable scissor(state, GL_SCISSOR_TEST);
  state->vtkglDisable(GL_SCISSOR_TEST);
  state->PushFramebufferBindings();
  window_->GetRenderFramebuffer()->Bind(GL_DRAW_FRAMEBUFFER);
  state->vtkglBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
  for (const Tile& part : parts_) {
    const int right = part.x + part.width, top = part.y + part.height;
    glBlitFramebuffer(part.x, part.y, right, top, part.x, part.y, right, top, GL_COLOR_BUFFER_BIT,
                      GL_NEAREST);
  }
  state->PopFramebufferBindings();
}

void FloorCache::Allocate(int width, int height) {
  if (texture_ != 0 && width == width_ && height == height_) return;
  Release();
  vtkOpenGLState* state = window_->GetState();
  glGenTextures(1, &texture_);
  glBindTexture(GL_TEXTURE_2D, texture_);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  glBindTexture(GL_TEXTURE_2D, 0);
  glGenFramebuffers(1, &framebuffer_);
  state->vtkglBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
  glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_, 0);
  width_ = width;
  height_ = height;
}

void FloorCache::Release() {
  if (texture_ == 0) return;
  glDeleteFramebuffers(1, &framebuffer_);
  glDeleteTextures(1, &texture_);
  framebuffer_ = texture_ = 0;
}

}  // namespace kinescope::render
