/// Reads the two clocks of the program and converts nanoseconds to seconds. Any thread.
#pragma once

#include <chrono>
#include <cstdint>

namespace kinescope {

namespace internal {
inline std::int64_t monotonic_shift_nanos = 0;
}

/// Monotonic clock, ns since an unspecified time, usually the start of the machine; never steps
/// back.
inline std::int64_t MonotonicNanos() {
  return internal::monotonic_shift_nanos + std::chrono::duration_cast<std::chrono::nanoseconds>(
                                               std::chrono::steady_clock::now().time_since_epoch())
                                               .count();
}

/// The monotonic clock of this process reads `nanos` now. For a server whose moments are to be the
/// same in each run. Call it before there are other threads.
inline void SetMonotonicClock(std::int64_t nanos) {
  internal::monotonic_shift_nanos += nanos - MonotonicNanos();
}

/// Wall clock, ns since 1970-01-01 UTC; steps when the clock of the machine is set.
inline std::int64_t WallNanos() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

inline constexpr std::int64_t kNanosPerMilli = 1'000'000;
inline constexpr std::int64_t kNanosPerSecond = 1'000'000'000;

/// `nanos` in s. Meant for the difference between two readings of the same clock: a time since 1970
/// keeps a resolution of only 0.2 us.
constexpr double Secs(std::int64_t nanos) { return static_cast<double>(nanos) * 1e-9; }
/// The same in ms.
constexpr double Millis(std::int64_t nanos) { return static_cast<double>(nanos) * 1e-6; }

}  // namespace kinescope
