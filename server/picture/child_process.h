/// Runs a program as a child process with a time limit, to isolate code that may hang or crash. Any
/// thread.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace kinescope::app {

struct ChildResult {
  int exit_code = 0;  // if it ended by itself
  int signal = 0;     // signal that ended it, except the kill after `limit`; 0: none
  bool was_too_slow = false;
  std::string out, err;  // at most the first 1 MiB of each
};

/// `command[0]` is a path. The child has this process' environment and no standard input, and is
/// killed after `limit`, and soon after `is_wanted` has returned false. @throws std::runtime_error
/// if it cannot be started.
[[nodiscard]] ChildResult RunChild(
    const std::vector<std::string>& command, std::chrono::milliseconds limit,
    const std::function<bool()>& is_wanted = [] { return true; });

/// The last line of messages, where programs that give up state the reason; "": there is none.
std::string LastLineOf(const std::string& messages);

}  // namespace kinescope::app
