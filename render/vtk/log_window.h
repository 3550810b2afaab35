/// Sends the warnings of VTK, OpenGL and EGL to the log of the active renderer, one line each.
#pragma once

#include <string>

#include "render/once_log.h"
#include "render/renderer.h"

namespace kinescope::render {

/// Logs to the renderer that is active on this thread; to stderr without one. `text` may have
/// several lines.
void LogHere(const std::string& text);

/// Sends warnings and errors of the current GL context to `log` from now on, if the context
/// supports it (KHR_debug). `log` must outlive the context.
void LogGlMessages(OnceLog& log);

/// While it exists, VTK's messages on this thread go to `log`; otherwise to stderr. Borrowed.
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
