/// Makes a GL context through EGL, without surface, window system or display: "egl" is Mesa's
/// software renderer (EGL_PLATFORM_SURFACELESS_MESA), "egl_device" the first GPU of
/// EGL_EXT_device_enumeration that works.
#pragma once

#include <string>

#include "render/vtk/gl_context.h"

namespace kinescope::render {

class EglContext : public GlContext {
 public:
  /// @throws RenderError with the attempts and the remedy.
  explicit EglContext(const std::string& backend);
  ~EglContext() override;
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  void MakeCurrent() override;

 private:
  // EGLDisplay and EGLContext. The display belongs to the process and is kept: two contexts may
  // share it.
  void* display_ = nullptr;
  void* context_ = nullptr;
};

}  // namespace kinescope::render
