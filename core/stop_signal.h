/// Ctrl-C and SIGTERM as a flag that loops look at; the second one kills.
#pragma once

namespace kinescope {

/// Call once, before threads are started.
void CatchStopSignals();
[[nodiscard]] bool StopRequested();

}  // namespace kinescope
