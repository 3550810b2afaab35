/// A GL context through EGL, without surface, window system or display: "egl" is Mesa's software
/// (EGL_PLATFORM_SURFACELESS_MESA), "egl_device" the first GPU of EGL_EXT_device_enumeration that
/// gives one.
#pragma once

#include <string>

#include "render/vtk/gl_context.h"

namespace kinescope::render {

class EglContext : public GlContext {
 public:
  /// @throws RenderError saying what was tried and what would help.
  explicit EglContext(const std::string& backend);
  ~EglContext() override;
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  void MakeCurrent() override;

 private:
  // EGLDisplay and EGLContext. A display is the process' and stays: two contexts may share it.
  void* display_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace kinescope::render
