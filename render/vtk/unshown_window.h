/// The render window of pictures that are read from memory. VTK copies the colours and depths of
/// each picture to a second framebuffer, for a display, which does not exist here: this window does
/// not, and leaves that framebuffer as small as the first picture. One thread.
#pragma once

#include <vtkGenericOpenGLRenderWindow.h>

namespace kinescope::render {

/// Render a first, small picture to create the framebuffers. The context is not VTK's.
class UnshownWindow : public vtkGenericOpenGLRenderWindow {
 public:
  static UnshownWindow* New();
  UnshownWindow(const UnshownWindow&) = delete;
  void operator=(const UnshownWindow&) = delete;

  /// Renders into `framebuffer` (GL's name) from now on, 0: into the window's own. It is at least
  /// as large as the viewports of the layers that are rendered.
  void SetTarget(unsigned framebuffer) { target_ = framebuffer; }
  /// GL's name of the window's own framebuffer.
  unsigned framebuffer();

  void Start() override;
  void Frame() override {}

 protected:
  UnshownWindow() = default;
  ~UnshownWindow() override = default;

 private:
  unsigned target_ = 0;
};

}  // namespace kinescope::render
