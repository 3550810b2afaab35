#include "core/system/stop_signal.h"

#include <atomic>
#include <csignal>

namespace kinescope {
namespace {

volatile std::sig_atomic_t stop_signal = 0;

volatile std::sig_atomic_t catches_hangup = 0, ends_at_second = 1;

std::atomic<bool (*)()> of_program = nullptr;

// The next signal, of whatever kind, ends the process at once.
void OnSignal(int signal) {
  stop_signal = signal;
  if (ends_at_second == 0) return;
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

bool StopRequested() {
  bool (*const program)() = of_program;
  return program != nullptr ? program() : stop_signal != 0;
}

int StopSignal() { return stop_signal; }

void IgnoreFurtherStopSignals() { ends_at_second = 0; }

void FollowStopRequestsOf(bool (*program)()) { of_program = program; }

}  // namespace kinescope
