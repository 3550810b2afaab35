/// A program run as a child with a time limit: for what may hang or crash and must not take us
/// along.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace kinescope::app {

struct ChildResult {
  int exit_code = 0;  // when it ended by itself
  int signal = 0;     // that ended it, ours excepted; 0: none
  bool was_too_slow = false;
  std::string out, err;  // at most 1 MiB of each is kept
};

/// `command[0]` is a path; the child has our environment and no standard input, and is killed after
/// `limit`. @throws std::runtime_error when it cannot be started.
[[nodiscard]] ChildResult RunChild(const std::vector<std::string>& command,
                                   std::chrono::milliseconds limit);

}  // namespace kinescope::app
