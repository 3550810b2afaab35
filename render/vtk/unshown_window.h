/// The render window of pictures that are read from memory. VTK copies the colours and depths of
/// each picture to a second framebuffer, for a display, which does not exist here. One thread.
#pragma once

#include <vtkGenericOpenGLRenderWindow.h>

namespace kinescope::render {

class UnshownWindow : public vtkGenericOpenGLRenderWindow {
 public:
  static UnshownWindow* New();
  UnshownWindow(const UnshownWindow&) = delete;
  void operator=(const UnshownWindow&) = delete;

  void Frame() override {}

 protected:
  UnshownWindow() = default;
  ~UnshownWindow() override = default;
};

}  // namespace kinescope::render
