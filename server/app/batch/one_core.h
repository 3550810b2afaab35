/// Keeps a process on one processor core. Linux; any thread.
#pragma once

namespace kinescope::app {

/// All threads of this process, and those that they start, share one core from now on, whatever
/// libraries start: the encoder of clips has as many threads on every machine, because its bytes
/// depend on their number. The core is one on which the kernel puts the process now, out of those
/// that it had at the start; call it for every job, so that processes that met on a core part.
void UseOneCore();

}  // namespace kinescope::app
