/// Turns Ctrl-C, SIGTERM and SIGHUP (the terminal was closed) into a flag that loops check; a
/// second signal ends the process. SIGHUP stays ignored where it is, as under nohup.
#pragma once

namespace kinescope {

/// Call once, before threads are started. StopRequested may then be called on any thread.
void CatchStopSignals();
[[nodiscard]] bool StopRequested();

/// Which signal requested it; 0: none did.
[[nodiscard]] int StopSignal();

/// From now on, further signals end nothing: of a process whose parent decides how long it waits.
/// Call it after CatchStopSignals().
void IgnoreFurtherStopSignals();

/// For a module, which has a flag of its own: from now on StopRequested() is that of `program`;
/// null: its own again.
void FollowStopRequestsOf(bool (*program)());

}  // namespace kinescope
