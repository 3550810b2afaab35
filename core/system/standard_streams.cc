#include "core/system/standard_streams.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <system_error>

namespace kinescope {

void OpenStandardStreams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(descriptor, F_GETFD) >= 0 || errno != EBADF) continue;
    // Gets the lowest free number, which is this one. Without /dev/null it stays closed.
    static_cast<void>(::open("/dev/null", O_RDWR));
  }
}

void FailOfStandardOutput(int error) {
  if (error == EPIPE) {
    std::signal(SIGPIPE, SIG_DFL);
    std::raise(SIGPIPE);
  }
  // An error of an earlier write is only known as such.
  throw std::runtime_error("cannot write to standard output" +
                           (error == 0 ? "" : ": " + std::generic_category().message(error)));
}

void FlushStandardOutput() {
  errno = 0;
  const bool is_written = std::fflush(stdout) == 0;
  if (is_written && std::ferror(stdout) == 0) return;
  FailOfStandardOutput(is_written ? 0 : errno);
}

}  // namespace kinescope
