/// A VTK actor that says how it meets what is in the picture already. All actors are drawn as
/// opaque, in the order in which they were added: VTK's own way of drawing translucent things would
/// cost two more full-screen buffers.
#pragma once

#include <vtkOpenGLActor.h>

namespace kinescope::render {

enum class Pass {
  kBackdrop,  // fills what it covers, whatever is drawn later lies in front of it
  kSolid,     // hides and is hidden, as things are
  kBlended,   // is hidden, hides nothing: soft shadows
  kGhost,     // only where something solid is in front of it; hides nothing
  kVeil,      // a body that one sees through, but only into its front; is drawn last
};

class PassActor : public vtkOpenGLActor {
 public:
  static PassActor* New();

  void SetPass(Pass pass) { pass_ = pass; }
  void Render(vtkRenderer* renderer, vtkMapper* mapper) override;

 private:
  Pass pass_ = Pass::kSolid;
};

}  // namespace kinescope::render
