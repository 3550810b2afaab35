#include "server/mvn/loss_meter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace kinescope::mvn {
namespace {

struct Losses {
  double counted = 0, real = 0;  // of the samples sent
};

// A stream that sends every `step`-th captured sample (a fraction: the next whole one) and loses
// `share` of those.
Losses LossesOf(double step, double share) {
  constexpr int kSent = 20000;
  std::mt19937 random(5);
  LossMeter meter;
  std::uint64_t counted = 0;
  int lost = 0;
  std::uint32_t last = 0;
  for (int i = 1; i < kSent; ++i) {
    if (static_cast<double>(random()) < share * 4294967296.0) {
      ++lost;
      continue;
    }
    const auto counter = static_cast<std::uint32_t>(std::ceil(i * step));
    counted += meter.Add(counter - last);
    last = counter;
  }
  return {static_cast<double>(counted) / kSent, static_cast<double>(lost) / kSent};
}

TEST(LossMeter, CountsNothingForAStreamThatLosesNothing) {
  for (const double step : {1.0, 2.0, 4.0, 2.4, 1.5, 4.0 / 3, 1.2, 10.0}) {
    EXPECT_EQ(LossesOf(step, 0).counted, 0) << step;
  }
}

TEST(LossMeter, CountsLostSamplesWithinATenthOfThem) {
  for (const double step : {1.0, 2.0, 4.0, 2.4, 1.5}) {
    for (const double share : {0.01, 0.05, 0.2}) {
      const Losses losses = LossesOf(step, share);
      EXPECT_NEAR(losses.counted, losses.real, 0.1 * losses.real) << step << " " << share;
    }
  }
}

TEST(LossMeter, CountsAnOutageAsAWhole) {
  LossMeter meter;
  for (int i = 0; i < 100; ++i) EXPECT_EQ(meter.Add(4), 0u);
  EXPECT_EQ(meter.Add(4 * 601), 600u);
  EXPECT_EQ(meter.Add(4), 0u);
}

TEST(LossMeter, LearnsTheUsualStepFirst) {
  LossMeter meter;
  EXPECT_EQ(meter.Add(7), 0u);
  for (int i = 0; i < 40; ++i) EXPECT_EQ(meter.Add(2), 0u) << i;
  EXPECT_EQ(meter.Add(6), 2u);
}

TEST(LossMeter, FollowsAnotherRateAfterASecond) {
  LossMeter meter;
  for (int i = 0; i < 1000; ++i) meter.Add(2);
  std::uint64_t lost = 0;
  for (int i = 0; i < 1000; ++i) lost += meter.Add(4);
  EXPECT_LE(lost, 33u);
}

}  // namespace
}  // namespace kinescope::mvn
