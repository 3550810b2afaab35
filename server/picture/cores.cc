#include "server/picture/cores.h"

#include <algorithm>
#include <thread>

namespace kinescope::app {

int CoresHere() { return static_cast<int>(std::max(1u, std::thread::hardware_concurrency())); }

int FillingThreads(int cores, int jobs) {
  // The thread that draws waits for them. By default llvmpipe takes one per core for each renderer,
  // which costs a twelfth more to wake up.
  constexpr int kMost = 8;
  return std::clamp(cores / jobs, 1, kMost);
}

}  // namespace kinescope::app
