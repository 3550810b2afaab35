/// The two clocks of the program, read in one place, and what their nanoseconds are in seconds.
#pragma once

#include <chrono>
#include <cstdint>

namespace kinescope {

inline std::int64_t MonotonicNanos() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

inline std::int64_t WallNanos() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

inline constexpr std::int64_t kNanosPerMilli = 1'000'000;
inline constexpr std::int64_t kNanosPerSecond = 1'000'000'000;

constexpr double Secs(std::int64_t nanos) { return static_cast<double>(nanos) * 1e-9; }

}  // namespace kinescope
