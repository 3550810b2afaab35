#include "server/mvn/net/arrival_clock.h"

#include <gtest/gtest.h>

#include "core/system/clocks.h"

namespace kinescope::mvn {
namespace {

constexpr std::int64_t kWallEpoch =
    1'700'000'000 * kNanosPerSecond;  // wall clock when the monotonic one is 0

// The time `secs` after the start; `set_by`: by how much the wall clock was set until then.
Arrival At(double secs, std::int64_t set_by = 0) {
  const auto nanos = static_cast<std::int64_t>(secs * 1e9);
  return {nanos, kWallEpoch + nanos + set_by};
}

TEST(ArrivalClock, KeepsTheKernelsStampHoweverLongTheDatagramWaited) {
  for (const double waited : {0.0, 0.002, 0.9, 1.1, 3.7, 600.0}) {
    ArrivalClock clock(At(1));
    EXPECT_EQ(clock.Read(At(10 + waited)), 0);
    const Arrival arrival = clock.ArrivalOf(At(10).wall_nanos);
    EXPECT_EQ(arrival.monotonic_nanos, At(10).monotonic_nanos) << waited << " s";
    EXPECT_EQ(arrival.wall_nanos, At(10).wall_nanos) << waited << " s";
  }
}

TEST(ArrivalClock, TakesTheTimeOfReadingWithoutAStamp) {
  ArrivalClock clock(At(1));
  clock.Read(At(5));
  EXPECT_EQ(clock.ArrivalOf(std::nullopt).monotonic_nanos, At(5).monotonic_nanos);
}

TEST(ArrivalClock, ReportsThatTheWallClockWasSetAndKeepsTheAgeOfWhatWaited) {
  for (const std::int64_t set_by :
       {3200 * kNanosPerMilli, -3200 * kNanosPerMilli, 3600 * kNanosPerSecond}) {
    ArrivalClock clock(At(0));
    clock.Read(At(10));
    clock.ArrivalOf(At(10).wall_nanos);
    // Stamped at 10.5 s, then the clock was set, then stamped at 11 s; both are read at 11.2 s.
    EXPECT_EQ(clock.Read(At(11.2, set_by)), set_by);
    const Arrival before = clock.ArrivalOf(At(10.5).wall_nanos);
    EXPECT_EQ(before.monotonic_nanos, At(10.5).monotonic_nanos) << set_by;
    EXPECT_EQ(before.wall_nanos, At(10.5, set_by).wall_nanos) << "on today's clock";
    const Arrival after = clock.ArrivalOf(At(11, set_by).wall_nanos);
    EXPECT_EQ(after.monotonic_nanos, At(11).monotonic_nanos) << set_by;
    EXPECT_EQ(clock.Read(At(11.3, set_by)), 0) << "reported once";
  }
}

TEST(ArrivalClock, FollowsAWallClockThatIsCorrectedGradually) {
  ArrivalClock clock(At(0));
  for (int i = 1; i <= 100; ++i) {
    const Arrival now = At(i, i * 10 * kNanosPerMilli);
    EXPECT_EQ(clock.Read(now), 0);
    EXPECT_EQ(clock.ArrivalOf(now.wall_nanos - kNanosPerMilli).monotonic_nanos,
              now.monotonic_nanos - kNanosPerMilli);
  }
}

TEST(ArrivalClock, NeverGoesBackNorBeyondTheTimeOfReading) {
  ArrivalClock clock(At(0));
  clock.Read(At(10));
  EXPECT_EQ(clock.ArrivalOf(At(10).wall_nanos).monotonic_nanos, At(10).monotonic_nanos);
  clock.Read(At(11));
  EXPECT_EQ(clock.ArrivalOf(kWallEpoch - 5 * kNanosPerSecond).monotonic_nanos,
            At(10).monotonic_nanos);
  EXPECT_EQ(clock.ArrivalOf(At(500).wall_nanos).monotonic_nanos, At(11).monotonic_nanos);
  EXPECT_EQ(clock.ArrivalOf(At(10.5).wall_nanos).monotonic_nanos, At(11).monotonic_nanos);
}

}  // namespace
}  // namespace kinescope::mvn
