/// A GL 3.2 core context without display or window. Each module has one file that makes its kind:
/// osmesa_context.cc or egl_context.cc; the drawing is the same.
#pragma once

#include <memory>
#include <string>

namespace kinescope::render {

/// Create, use and destroy it on one thread.
class GlContext {
 public:
  virtual ~GlContext() = default;

  /// To be called before any GL command: another renderer on this thread may have been drawing.
  /// @throws RenderError.
  virtual void MakeCurrent() = 0;
};

/// One of `backend`, current on this thread. Defined by the module's own kind of GL.
/// @throws RenderError naming why there is none and what would help.
std::unique_ptr<GlContext> MakeGlContext(const std::string& backend);

}  // namespace kinescope::render
