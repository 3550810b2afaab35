/// Turns Ctrl-C and SIGTERM into a flag that loops check; a second signal ends the process.
#pragma once

namespace kinescope {

/// Call once, before threads are started. StopRequested may then be called on any thread.
void CatchStopSignals();
[[nodiscard]] bool StopRequested();

}  // namespace kinescope
