/// Runs a child process and exchanges lines with it. It is killed with the test, however the test
/// ends.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace kinescope::testing {

class Process {
 public:
  /// `command[0]` is the path of a program. It has this process' environment. @throws
  /// std::runtime_error.
  explicit Process(const std::vector<std::string>& command);
  ~Process();  // kills it
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void Signal(int number) const;
  void WriteLine(const std::string& line) const;
  /// Its next line, waiting up to `timeout`; nullopt without one, or if the process has ended.
  std::optional<std::string> ReadLine(std::chrono::milliseconds timeout);
  /// Waits for its end: the exit code, 128 + n when signal n ended it.
  int WaitForEnd();

  pid_t pid() const { return pid_; }

 private:
  pid_t pid_ = -1;  // -1: it has ended
  int to_child_ = -1;
  int from_child_ = -1;
  std::string unread_;
};

}  // namespace kinescope::testing
