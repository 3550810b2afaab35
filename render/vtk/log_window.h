/// Where VTK's own warnings go: one line each to the log of the renderer that is drawing.
#pragma once

#include "render/renderer.h"

namespace kinescope::render {

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
