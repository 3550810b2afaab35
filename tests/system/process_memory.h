/// What the kernel tells of a process' memory.
#pragma once

#include <sys/types.h>

#include <fstream>
#include <string>

namespace kinescope::testing {

/// An entry of /proc/PID/status in MB: "VmRSS:" (now) or "VmHWM:" (the most so far). 0: there is
/// none.
inline double MegabytesOf(pid_t pid, const std::string& entry) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string word; status >> word;) {
    double kib = 0;
    if (word == entry && status >> kib) return kib / 1000;
  }
  return 0;
}

}  // namespace kinescope::testing
