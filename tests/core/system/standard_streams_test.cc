#include "core/system/standard_streams.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "tests/full_disk.h"

namespace kinescope {
namespace {

// Exit code of a child that runs `check`, which returns true if all is well.
template <class Check>
int ExitCodeOf(const Check& check) {
  const pid_t child = fork();
  if (child == 0) _exit(check() ? 0 : 1);
  int status = -1;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string TargetOf(int descriptor) {
  std::error_code closed;
  return std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(descriptor), closed);
}

TEST(StandardStreams, ClosedOnesAreReplacedByTheNullDevice) {
  EXPECT_EQ(ExitCodeOf([] {
              for (const int descriptor : {0, 1, 2}) close(descriptor);
              OpenStandardStreams();
              return TargetOf(0) == "/dev/null" && TargetOf(1) == "/dev/null" &&
                     TargetOf(2) == "/dev/null";
            }),
            0);
}

TEST(StandardStreams, OpenOnesStayAsTheyAre) {
  const std::string before = TargetOf(2);
  EXPECT_EQ(ExitCodeOf([&] {
              close(0);
              OpenStandardStreams();
              return TargetOf(0) == "/dev/null" && TargetOf(2) == before;
            }),
            0);
}

TEST(StandardStreams, AFailedWriteIsReportedAtTheEnd) {
  const testing::FullStdout full;
  std::fputs("a result", stdout);
  EXPECT_THROW(FlushStandardOutput(), std::runtime_error);
}

TEST(StandardStreams, AnEarlierFailedFlushIsReportedAtTheEnd) {
  const testing::FullStdout full;
  std::fputs("a result", stdout);
  EXPECT_NE(std::fflush(stdout), 0);
  EXPECT_THROW(FlushStandardOutput(), std::runtime_error);
}

}  // namespace
}  // namespace kinescope
