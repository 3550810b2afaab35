/// Simulates a full disk for files and for standard output.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <stdio_ext.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstddef>
#include <cstdio>

namespace kinescope::testing {

/// While it exists, no file of this process can grow beyond `bytes`: as on a full disk, a write
/// fails with a reason ("File too large").
class SmallFilesOnly {
 public:
  explicit SmallFilesOnly(std::size_t bytes) : signal_before_(signal(SIGXFSZ, SIG_IGN)) {
    EXPECT_EQ(getrlimit(RLIMIT_FSIZE, &before_), 0);
    const rlimit small{bytes, before_.rlim_max};
    EXPECT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  }
  ~SmallFilesOnly() {
    setrlimit(RLIMIT_FSIZE, &before_);
    signal(SIGXFSZ, signal_before_);
  }
  SmallFilesOnly(const SmallFilesOnly&) = delete;
  SmallFilesOnly& operator=(const SmallFilesOnly&) = delete;

 private:
  sighandler_t signal_before_;
  rlimit before_{};
};

/// While it exists, standard output is /dev/full. Output that could not be written is discarded.
class FullStdout {
 public:
  FullStdout() {
    std::fflush(stdout);
    before_ = dup(STDOUT_FILENO);
    const int full = open("/dev/full", O_WRONLY);
    EXPECT_GE(full, 0);
    dup2(full, STDOUT_FILENO);
    close(full);
  }
  ~FullStdout() {
    __fpurge(stdout);
    std::clearerr(stdout);
    dup2(before_, STDOUT_FILENO);
    close(before_);
  }
  FullStdout(const FullStdout&) = delete;
  FullStdout& operator=(const FullStdout&) = delete;

 private:
  int before_ = -1;
};

}  // namespace kinescope::testing
