#include "server/mvn/clock_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace kinescope::mvn {
namespace {

constexpr double kRate = 240;
constexpr double kSamplePeriod = 1e9 / kRate;
constexpr std::int64_t kEpoch = 1'700'000'000'000'000'000;
constexpr std::int64_t kBoot = 1'000'000'000'000;

// A sender at 240 Hz, seen through a network whose delay has a floor of 1 ms and a long tail.
class ClockFitTest : public ::testing::Test {
 protected:
  std::uint32_t MillisOf(std::uint32_t counter) const {
    return static_cast<std::uint32_t>(std::floor(counter * 1000.0 / kRate));
  }
  double Delay() { return 1e6 + std::exponential_distribution<double>(1 / 4e6)(engine_); }

  // Arrival of what the sender sends at `nanos` after start.
  Arrival ArriveAt(double nanos) const {
    const auto whole = static_cast<std::int64_t>(nanos);
    return {kBoot + whole, kEpoch + wall_step_ + whole};
  }

  std::int64_t Stamp(std::uint32_t counter, double nanos) {
    return fit_.Stamp(counter, MillisOf(counter), ArriveAt(nanos));
  }

  ClockFit fit_;
  std::mt19937 engine_{9};
  std::int64_t wall_step_ = 0;
};

double Deviation(const std::vector<double>& values) {
  double sum = 0, squares = 0;
  for (const double value : values) sum += value, squares += value * value;
  const double mean = sum / static_cast<double>(values.size());
  return std::sqrt(std::max(0.0, squares / static_cast<double>(values.size()) - mean * mean));
}

TEST_F(ClockFitTest, RemovesNetworkJitterFromTimeStamps) {
  std::vector<double> stamp_steps, arrival_steps, errors;
  double last_arrival = 0;
  std::int64_t last_stamp = 0;
  for (std::uint32_t counter = 0; counter < 20 * 240; ++counter) {
    const double sent = counter * kSamplePeriod;
    const double arrival = std::max(sent + Delay(), last_arrival);  // no overtaking
    const std::int64_t stamp = Stamp(counter, arrival);
    if (counter > 5 * 240) {
      stamp_steps.push_back(static_cast<double>(stamp - last_stamp));
      arrival_steps.push_back(arrival - last_arrival);
      errors.push_back(static_cast<double>(stamp - kEpoch) - sent);
    }
    last_arrival = arrival;
    last_stamp = stamp;
  }
  EXPECT_GT(Deviation(arrival_steps), 2.5e6) << "the network of this test must shake";
  EXPECT_LT(Deviation(stamp_steps), 0.1e6) << "and stamps must not, nor feel the rounded time code";
  // The floor of the delay remains, and half a millisecond of the time code's rounding down.
  for (const double error : errors) EXPECT_NEAR(error, 1e6, 0.8e6);
}

// The first time code may be rounded by nothing and those after it by half a millisecond: for the
// first five seconds the stamps were that much too early.
TEST_F(ClockFitTest, StampsAreSoonTheTimesOfArrivalOfAStreamWithoutDelay) {
  for (const double rate : {24.0, 60.0, 100.0, 120.0, 240.0}) {
    for (const double start_millis : {0.0, 0.3, 0.5, 0.99}) {
      ClockFit fit;
      double earliest = 0;
      for (std::uint32_t counter = 0; counter < 8 * rate; ++counter) {
        const Arrival arrival = ArriveAt(counter * 1e9 / rate);
        const auto millis = static_cast<std::uint32_t>(counter * 1000 / rate + start_millis);
        const std::int64_t stamp = fit.Stamp(counter, millis, arrival);
        if (counter > 40) {
          earliest = std::min(earliest, static_cast<double>(stamp - arrival.wall_nanos));
        }
      }
      EXPECT_GT(earliest, -0.08e6) << rate << " Hz, first time code rounded by " << start_millis;
    }
  }
}

TEST_F(ClockFitTest, FollowsASenderWhoseClockDrifts) {
  constexpr double kDrift = 100e-6;
  double error = 0;
  for (std::uint32_t counter = 0; counter < 120 * 240; ++counter) {
    const double sent = counter * kSamplePeriod * (1 + kDrift);
    error = static_cast<double>(Stamp(counter, sent + Delay()) - kEpoch) - sent;
    if (counter < 5 * 240) continue;  // the fit has not seen a fast way yet
    ASSERT_NEAR(error, 1e6, 1.5e6) << "at sample " << counter;
  }
}

// A recording that is played at half its speed, for example: the stamps were up to half a second
// late, in a saw-tooth.
TEST_F(ClockFitTest, FollowsASenderThatIsSlowerThanItsTimeCode) {
  for (const double speed : {0.9, 0.5, 0.2}) {
    ClockFit fit;
    double worst_late = 0, worst_early = 0;
    for (std::uint32_t counter = 0; counter < 20 * 240; ++counter) {
      const double sent = counter * kSamplePeriod / speed;
      const std::int64_t stamp = fit.Stamp(counter, MillisOf(counter), ArriveAt(sent + Delay()));
      if (sent < 1e9) continue;  // the fit has not seen how fast it is
      const double error = static_cast<double>(stamp - kEpoch) - sent;
      worst_late = std::max(worst_late, error);
      worst_early = std::min(worst_early, error);
    }
    EXPECT_LT(worst_late, 30e6) << "speed " << speed;
    EXPECT_GT(worst_early, -30e6) << "speed " << speed;
  }
}

TEST_F(ClockFitTest, ReturnsIncreasingTimeStampsNotAfterTheReceiveTime) {
  std::int64_t last_stamp = 0;
  double last_arrival =
      30 * kSamplePeriod;  // the first thirty come in one burst, as MVN sends them
  for (std::uint32_t counter = 0; counter < 2000; ++counter) {
    const double arrival = std::max(counter * kSamplePeriod + Delay(), last_arrival + 0.2e6);
    const std::int64_t stamp = Stamp(counter, arrival);
    ASSERT_GT(stamp, last_stamp) << "at sample " << counter;
    ASSERT_LE(stamp, ArriveAt(arrival).wall_nanos) << "at sample " << counter;
    last_stamp = stamp;
    last_arrival = arrival;
  }
}

TEST_F(ClockFitTest, RestartsAfterThePauseOfASender) {
  std::uint32_t counter = 0;
  for (; counter < 1000; ++counter) Stamp(counter, counter * kSamplePeriod + Delay());
  const double pause = 3e9;  // its time code stood still meanwhile
  for (; counter < 1100; ++counter) {
    const double arrival = counter * kSamplePeriod + pause + Delay();
    const std::int64_t stamp = Stamp(counter, arrival);
    EXPECT_NEAR(static_cast<double>(stamp - kEpoch), counter * kSamplePeriod + pause, 40e6);
  }
}

TEST_F(ClockFitTest, RestartsWhenTheTimeCodeJumpsAgainstTheCounter) {
  std::uint32_t counter = 0;
  for (; counter < 1000; ++counter) Stamp(counter, counter * kSamplePeriod);
  for (; counter < 1100; ++counter) {
    const std::int64_t stamp =
        fit_.Stamp(counter, MillisOf(counter) + 3'600'000, ArriveAt(counter * kSamplePeriod));
    EXPECT_NEAR(static_cast<double>(stamp - kEpoch), counter * kSamplePeriod, 2e6);
  }
}

TEST_F(ClockFitTest, UsesTheReceiveTimeIfTheTimeCodeStandsStill) {
  for (std::uint32_t counter = 0; counter < 1000; ++counter) {
    const Arrival arrival = ArriveAt(counter * kSamplePeriod);
    EXPECT_EQ(fit_.Stamp(counter, 0, arrival), arrival.wall_nanos);
  }
}

TEST_F(ClockFitTest, FollowsTheWallClockWhenItIsSet) {
  std::uint32_t counter = 0;
  for (; counter < 1000; ++counter) Stamp(counter, counter * kSamplePeriod);
  for (const std::int64_t step : {5'000'000'000, -5'000'000'000}) {
    wall_step_ += step;
    for (const std::uint32_t end = counter + 10; counter < end; ++counter) {
      const double error =
          static_cast<double>(Stamp(counter, counter * kSamplePeriod) - kEpoch - wall_step_) -
          counter * kSamplePeriod;
      EXPECT_NEAR(error, 0, 2e6);
    }
  }
}

}  // namespace
}  // namespace kinescope::mvn
