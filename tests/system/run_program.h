/// Runs a program to its end, as a shell would, and keeps what it said.
#pragma once

#include <string>
#include <vector>

namespace kinescope::testing {

struct ProgramResult {
  int exit_code = 0;  // 128 + n when signal n ended it
  std::string out;
  std::string err;
};

/// `command[0]` is a path. `environment`: "NAME=value" to add. Killed after `timeout_secs`.
/// @throws std::runtime_error when it cannot be started.
ProgramResult RunProgram(const std::vector<std::string>& command,
                         const std::vector<std::string>& environment = {}, int timeout_secs = 240);

/// Also without being root: a user namespace has mounts of its own.
bool CanMount();

}  // namespace kinescope::testing
