#include "core/system/stop_signal.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

namespace kinescope {
namespace {

// In a child, whose handlers are its own: 0 if `signal` requests the stop, 1 if it does nothing;
// 128 + the signal if it ends the process.
int EffectOf(int signal, bool is_ignored_at_start) {
  const pid_t child = fork();
  if (child == 0) {
    std::signal(signal, is_ignored_at_start ? SIG_IGN : SIG_DFL);
    CatchStopSignals();
    std::raise(signal);
    _exit(StopRequested() ? 0 : 1);
  }
  int status = -1;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST(StopSignal, IsSentByCtrlCByServiceManagersAndByAClosedTerminal) {
  EXPECT_EQ(EffectOf(SIGINT, false), 0);
  EXPECT_EQ(EffectOf(SIGTERM, false), 0);
  EXPECT_EQ(EffectOf(SIGHUP, false), 0);
}

TEST(StopSignal, AClosedTerminalStopsNothingUnderNohup) { EXPECT_EQ(EffectOf(SIGHUP, true), 1); }

}  // namespace
}  // namespace kinescope
