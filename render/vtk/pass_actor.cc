#include "render/vtk/pass_actor.h"

#include <GL/glew.h>
#include <vtkMapper.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLRenderer.h>
#include <vtkOpenGLState.h>

namespace kinescope::render {

vtkStandardNewMacro(PassActor)

    void PassActor::Render(vtkRenderer* renderer, vtkMapper* mapper) {
  vtkOpenGLState* state = static_cast<vtkOpenGLRenderer*>(renderer)->GetState();
  const vtkOpenGLState::ScopedglDepthMask mask(state);
  const vtkOpenGLState::ScopedglDepthFunc function(state);
  const vtkOpenGLState::ScopedglEnableDisable blend(state, GL_BLEND);
  const vtkOpenGLState::ScopedglEnableDisable depth(state, GL_DEPTH_TEST);
  // Blending costs software GL a second memory access and arithmetic for every pixel.
  const bool has_opacity = pass_ != Pass::kBackdrop && pass_ != Pass::kSolid;
  if (pass_ == Pass::kVeil) {  // its nearest surface first, as depth alone
    const vtkOpenGLState::ScopedglColorMask colors(state);
    state->vtkglColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    state->vtkglDepthMask(GL_TRUE);
    state->vtkglDepthFunc(GL_LEQUAL);
    mapper->Render(renderer, this);
  }
  state->SetEnumState(GL_BLEND, has_opacity);
  state->SetEnumState(GL_DEPTH_TEST, pass_ != Pass::kBackdrop);  // it is drawn first
  const bool hides = pass_ == Pass::kSolid || pass_ == Pass::kGroundDepth;
  state->vtkglDepthMask(hides ? GL_TRUE : GL_FALSE);
  state->vtkglDepthFunc(pass_ == Pass::kGhost ? GL_GREATER : GL_LEQUAL);
  if (pass_ != Pass::kGround && pass_ != Pass::kGroundDepth) {
    mapper->Render(renderer, this);
    return;
  }
  const vtkOpenGLState::ScopedglColorMask colors(state);
  const bool is_depth = pass_ == Pass::kGroundDepth;
  if (is_depth) state->vtkglColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(is_depth ? 5 : 4, 0);  // pixels along the slope
  mapper->Render(renderer, this);
  glDisable(GL_POLYGON_OFFSET_FILL);
}

}  // namespace kinescope::render
