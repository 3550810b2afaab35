/// A VTK actor with a rule for hiding and being hidden. All actors are rendered as opaque, in the
/// order in which they were added, because VTK's own translucent rendering would need two more
/// full-screen buffers.
#pragma once

#include <vtkOpenGLActor.h>

namespace kinescope::render {

enum class Pass {
  kBackdrop,     // covers what is behind it, and is covered by all later actors
  kSolid,        // hides and is hidden by depth
  kGround,       // is hidden, hides nothing that is in front of it or a few pixels behind it: what
                 // lies on it, or turns to the viewer there, is seen whole
  kGroundDepth,  // before kGround: its depth alone, so that it hides what is behind it
  kBlended,      // is hidden, hides nothing: soft shadows
  kGhost,        // visible only where something solid is in front of it; hides nothing
  kVeil,         // a translucent body of which only the front is visible; rendered last
};

class PassActor : public vtkOpenGLActor {
 public:
  static PassActor* New();

  void SetPass(Pass pass) { pass_ = pass; }
  Pass pass() const { return pass_; }
  void Render(vtkRenderer* renderer, vtkMapper* mapper) override;

 private:
  Pass pass_ = Pass::kSolid;
};

}  // namespace kinescope::render
