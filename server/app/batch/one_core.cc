#include "server/app/batch/one_core.h"

#include <sched.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace kinescope::app {
namespace {

cpu_set_t CoresAtStart() {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  ::sched_getaffinity(0, sizeof cores, &cores);
  return cores;
}

// A thread may end meanwhile, and a core may be taken away: then it stays as it is.
void Move(const cpu_set_t& cores) {
  std::error_code error;
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task", error)) {
    ::sched_setaffinity(std::atoi(thread.path().filename().c_str()), sizeof cores, &cores);
  }
}

}  // namespace

void UseOneCore() {
  static const cpu_set_t kAll = CoresAtStart();
  if (CPU_COUNT(&kAll) <= 1) return;
  Move(kAll);
  ::sched_yield();
  const int core = ::sched_getcpu();
  if (core < 0 || !CPU_ISSET(core, &kAll)) return;
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(core, &one);
  Move(one);
}

}  // namespace kinescope::app
