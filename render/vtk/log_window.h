/// Where the warnings of VTK, OpenGL and EGL go: one line each to the log of the renderer that is
/// drawing.
#pragma once

#include <string>

#include "render/renderer.h"
#include "render/shape/once_log.h"

namespace kinescope::render {

/// To the log of the renderer that is drawing on this thread; to stderr when none is. `text` may
/// have several lines.
void LogHere(const std::string& text);

/// Warnings and errors of the GL context that is current go to `log` from now on, where the context
/// can tell (KHR_debug). `log` outlives the context.
void LogGlMessages(OnceLog& log);

/// While it lives, VTK's messages of this thread go to `log`; otherwise to stderr. Borrowed.
class VtkLogScope {
 public:
  explicit VtkLogScope(const LogLine& log);
  ~VtkLogScope();
  VtkLogScope(const VtkLogScope&) = delete;
  VtkLogScope& operator=(const VtkLogScope&) = delete;

 private:
  const LogLine* const outer_;
};

}  // namespace kinescope::render
