/// The CPU time of this process, all threads, s.
#pragma once

#include <sys/resource.h>

namespace kinescope {

inline double CpuSecs() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto secs = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return secs(usage.ru_utime) + secs(usage.ru_stime);
}

}  // namespace kinescope
