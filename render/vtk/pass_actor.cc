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
  // Blending costs software GL a second memory access and arithmetic for every pixel.
  const bool has_opacity = pass_ == Pass::kBlended || pass_ == Pass::kGhost;
  state->SetEnumState(GL_BLEND, has_opacity);
  state->vtkglDepthMask(pass_ == Pass::kSolid ? GL_TRUE : GL_FALSE);
  state->vtkglDepthFunc(pass_ == Pass::kGhost ? GL_GREATER : GL_LEQUAL);
  mapper->Render(renderer, this);
}

}  // namespace kinescope::render
