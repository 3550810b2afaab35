// Preloaded into the program under test: the wall clock of a computer that is set wrong, and set
// again while the program runs. The file $WRONG_CLOCK has the difference from the true one: ns, an
// int64 in the order of this machine.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <ctime>

namespace {

using Nanos = std::atomic<std::int64_t>;
constexpr std::int64_t kNanosPerSecond = 1'000'000'000;

// Null: the clock is right.
const Nanos* MapFile() {
  const char* path = std::getenv("WRONG_CLOCK");
  const int file = path == nullptr ? -1 : ::open(path, O_RDONLY | O_CLOEXEC);
  if (file < 0) return nullptr;
  void* const map = ::mmap(nullptr, sizeof(Nanos), PROT_READ, MAP_SHARED, file, 0);
  ::close(file);
  return map == MAP_FAILED ? nullptr : static_cast<const Nanos*>(map);
}

}  // namespace

extern "C" int clock_gettime(clockid_t which, timespec* time) noexcept {
  using Function = int (*)(clockid_t, timespec*);
  static const auto real = reinterpret_cast<Function>(::dlsym(RTLD_NEXT, "clock_gettime"));
  static const Nanos* const wrong_by = MapFile();
  const int result = real(which, time);
  if (result != 0 || which != CLOCK_REALTIME || wrong_by == nullptr) return result;
  const std::int64_t nanos = time->tv_sec * kNanosPerSecond + time->tv_nsec + *wrong_by;
  time->tv_sec = nanos / kNanosPerSecond;
  time->tv_nsec = nanos % kNanosPerSecond;
  return result;
}
