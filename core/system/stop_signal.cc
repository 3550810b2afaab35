#include "core/system/stop_signal.h"

#include <csignal>

namespace kinescope {
namespace {

volatile std::sig_atomic_t stop_requested = 0;

volatile std::sig_atomic_t catches_hangup = 0;

// The next signal, of whatever kind, ends the process at once.
void OnSignal(int) {
  stop_requested = 1;
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  if (catches_hangup != 0) std::signal(SIGHUP, SIG_DFL);
}

}  // namespace

void CatchStopSignals() {
  struct sigaction action = {};
  action.sa_handler = OnSignal;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction before = {};
  sigaction(SIGHUP, nullptr, &before);
  if (before.sa_handler == SIG_IGN) return;  // under nohup
  catches_hangup = 1;
  sigaction(SIGHUP, &action, nullptr);
}

bool StopRequested() { return stop_requested != 0; }

}  // namespace kinescope
