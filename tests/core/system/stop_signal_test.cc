#include "core/system/stop_signal.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <string>

#include "core/system/input_file.h"
#include "tests/temp_folder.h"

namespace kinescope {
namespace {

// In a child, whose handlers are its own: what `body` returns; 128 + the signal if one ends it.
template <class Body>
int InAChild(const Body& body) {
  const pid_t child = fork();
  if (child == 0) _exit(body());
  int status = -1;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

// 0 if `signal` requests the stop, 1 if it does nothing.
int EffectOf(int signal, bool is_ignored_at_start) {
  return InAChild([&] {
    std::signal(signal, is_ignored_at_start ? SIG_IGN : SIG_DFL);
    CatchStopSignals();
    std::raise(signal);
    return StopRequested() ? 0 : 1;
  });
}

TEST(StopSignal, IsSentByCtrlCByServiceManagersAndByAClosedTerminal) {
  EXPECT_EQ(EffectOf(SIGINT, false), 0);
  EXPECT_EQ(EffectOf(SIGTERM, false), 0);
  EXPECT_EQ(EffectOf(SIGHUP, false), 0);
}

TEST(StopSignal, AClosedTerminalStopsNothingUnderNohup) { EXPECT_EQ(EffectOf(SIGHUP, true), 1); }

TEST(StopSignal, OfTheProgramIsThatOfAModule) {
  FollowStopRequestsOf([] { return true; });
  EXPECT_TRUE(StopRequested());
  FollowStopRequestsOf(nullptr);
  EXPECT_FALSE(StopRequested());
}

// A signal that comes between two reads interrupts neither.
TEST(StopSignal, EndsAPipeThatIsReadAfterIt) {
  const testing::TempFolder folder;
  const std::string path = folder / "pipe";
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  EXPECT_EQ(InAChild([&] {
              alarm(20);  // for a reader that never ends
              CatchStopSignals();
              std::FILE* const writer = std::fopen(path.c_str(), "r+");
              std::fputs("what has come, with more than a head", writer);
              std::fflush(writer);
              std::raise(SIGTERM);
              InputFile pipe = OpenInputFile(path);
              std::array<char, 100> content{};
              const std::size_t count = std::fread(content.data(), 1, content.size(), pipe.get());
              return count == 36 && std::feof(pipe.get()) != 0 ? 0 : 1;
            }),
            0);
}

TEST(StopSignal, EndsANamedPipeThatHasNoWriter) {
  const testing::TempFolder folder;
  const std::string path = folder / "pipe";
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  EXPECT_EQ(InAChild([&] {
              alarm(20);
              CatchStopSignals();
              std::raise(SIGTERM);
              return OpenInputFile(path).head().empty() ? 0 : 1;
            }),
            0);
}

}  // namespace
}  // namespace kinescope
