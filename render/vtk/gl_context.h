/// A GL 3.2 core context without display or window. Each module has one file that makes its kind:
/// osmesa_context.cc or egl_context.cc; the rendering code is the same.
#pragma once

#include <memory>
#include <string>

namespace kinescope::render {

/// Create, use and destroy it on one thread.
class GlContext {
 public:
  virtual ~GlContext() = default;

  /// Call it before any GL command: another renderer on this thread may have been active. @throws
  /// RenderError.
  virtual void MakeCurrent() = 0;
};

/// A context of `backend`, current on this thread. Defined in the module's own file.
/// @throws RenderError with the reason and the remedy.
std::unique_ptr<GlContext> MakeGlContext(const std::string& backend);

}  // namespace kinescope::render
