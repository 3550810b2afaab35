#include "render/vtk/unshown_window.h"

#include <GL/glew.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLState.h>

namespace kinescope::render {

vtkStandardNewMacro(UnshownWindow);

// As vtkOpenGLRenderWindow::Start of VTK 9.1, which resizes both framebuffers: the one for a
// display has three textures, 42 MB at 1280 x 720 and 2 x 2 pixels drawn for each.
void UnshownWindow::Start() {
  if (RenderFramebuffer->GetFBOIndex() == 0) {
    vtkGenericOpenGLRenderWindow::Start();
    return;
  }
  MakeCurrent();
  vtkOpenGLState* const gl = GetState();
  gl->Initialize(this);
  gl->vtkglEnable(GL_BLEND);
  gl->vtkglBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  gl->PushFramebufferBindings();
  if (target_ != 0) {
    gl->vtkglBindFramebuffer(GL_FRAMEBUFFER, target_);
    return;
  }
  RenderFramebuffer->Resize(Size[0], Size[1]);
  RenderFramebuffer->Bind();
  RenderFramebuffer->ActivateDrawBuffer(0);
}

unsigned UnshownWindow::framebuffer() { return RenderFramebuffer->GetFBOIndex(); }

}  // namespace kinescope::render
