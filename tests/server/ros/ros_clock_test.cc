// Stamps under simulated time: steady between ticks, at any rate, and still while it stands still.
#include "server/ros/ros_clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "core/system/clocks.h"

namespace kinescope::ros_bridge {
namespace {

constexpr std::int64_t kStart = 1'700'000'000 * kNanosPerSecond;
constexpr std::int64_t kSample = kNanosPerSecond / 240;

// The clock of a simulator at `wall`, in ticks of its own time.
std::int64_t Simulated(std::int64_t wall, double rate, std::int64_t tick) {
  const auto ros = static_cast<std::int64_t>(rate * static_cast<double>(wall - kStart));
  return 100 * kNanosPerSecond + ros / tick * tick;
}

struct Steps {
  std::int64_t shortest = INT64_MAX, longest = 0, worst_error = 0;
};

// Of the stamps of a stream of 240 Hz, after the first second.
Steps Follow(RosClock& clock, double rate, std::int64_t tick) {
  Steps steps;
  std::int64_t before = 0;
  for (std::int64_t wall = kStart; wall < kStart + 10 * kNanosPerSecond; wall += kSample) {
    clock.Observe(wall, Simulated(wall, rate, tick));
    const std::int64_t stamp = *clock.ToRos(wall);
    if (wall > kStart + kNanosPerSecond) {
      steps.shortest = std::min(steps.shortest, stamp - before);
      steps.longest = std::max(steps.longest, stamp - before);
      const std::int64_t error = std::abs(stamp - Simulated(wall, rate, 1));
      steps.worst_error = std::max(steps.worst_error, error);
    }
    before = stamp;
  }
  return steps;
}

TEST(RosClock, StampsSteadilyBetweenTicks) {
  for (const double rate : {0.3, 1.0, 3.0}) {
    for (const std::int64_t tick : {kNanosPerMilli, 10 * kNanosPerMilli, 100 * kNanosPerMilli}) {
      SCOPED_TRACE(::testing::Message() << "rate " << rate << ", tick " << tick);
      RosClock clock;
      const Steps steps = Follow(clock, rate, tick);
      EXPECT_GT(steps.shortest, 0) << "a stamp that another sample has had is dropped by tf2";
      EXPECT_LE(steps.worst_error, tick + static_cast<std::int64_t>(rate * kSample));
    }
  }
}

TEST(RosClock, HasNoTimeBeforeTheFirstTick) {
  RosClock clock;
  clock.Observe(kStart, 0);
  EXPECT_FALSE(clock.ToRos(kStart));
  EXPECT_EQ(clock.FromRos(kStart), kStart);
}

TEST(RosClock, StandsStillWithTheSimulator) {
  RosClock clock;
  std::int64_t wall = kStart;
  const std::int64_t tick = 10 * kNanosPerMilli;
  for (; wall < kStart + 3 * kNanosPerSecond; wall += kSample) {
    clock.Observe(wall, Simulated(wall, 1, tick));
  }
  const std::int64_t paused = Simulated(wall, 1, tick);
  for (int i = 0; i < 1000; ++i, wall += kSample) clock.Observe(wall, paused);
  EXPECT_LE(*clock.ToRos(wall), paused + tick);
  EXPECT_EQ(*clock.ToRos(wall), *clock.ToRos(wall + kSample));
  EXPECT_EQ(clock.jumps(), 0);
}

TEST(RosClock, FollowsAClockThatIsStartedOver) {
  RosClock clock;
  clock.Observe(kStart, 500 * kNanosPerSecond);
  clock.Observe(kStart + kSample, kNanosPerSecond);
  EXPECT_EQ(clock.jumps(), 1);
  EXPECT_EQ(*clock.ToRos(kStart + kSample), kNanosPerSecond);
  clock.Observe(kStart + 2 * kSample, 900 * kNanosPerSecond);
  EXPECT_EQ(clock.jumps(), 2);
  EXPECT_EQ(*clock.ToRos(kStart + 2 * kSample), 900 * kNanosPerSecond);
}

TEST(RosClock, ConvertsBack) {
  RosClock clock;
  (void)Follow(clock, 0.5, 10 * kNanosPerMilli);
  const std::int64_t wall = kStart + 9 * kNanosPerSecond;
  EXPECT_NEAR(static_cast<double>(clock.FromRos(*clock.ToRos(wall)) - wall), 0, 10);
}

}  // namespace
}  // namespace kinescope::ros_bridge
