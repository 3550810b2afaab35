#include "server/loads/exposure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/system/clocks.h"
#include "tests/server/loads/loads_testing.h"

namespace kinescope::loads::testing {
namespace {

constexpr double kUnknownRatio = std::numeric_limits<double>::quiet_NaN();

std::vector<JointLoad> LoadsOf(double ratio) {
  JointLoad load;
  load.ratio = ratio;
  load.band = BandOf(ratio, kDefaultClassLimits);
  load.deciding_moment = 100 * ratio;
  load.capacity = 100;
  load.channel = "flexion";
  return std::vector<JointLoad>(urdf::kScoredJointCount, load);
}

JointExposure ExposureOf(const std::vector<double>& ratios, std::int64_t step_millis = 100) {
  Exposure exposure;
  std::int64_t now = 0;
  for (const double ratio : ratios)
    exposure.Add(LoadsOf(ratio), step_millis * kNanosPerMilli * now++);
  exposure.Finish();
  return exposure.Of(3);
}

std::size_t Index(LoadClass band) { return static_cast<std::size_t>(band); }

// The worked example of biomech-files.md C.1, ten times as fast.
TEST(Exposure, MatchesTheWorkedExample) {
  const JointExposure joint =
      ExposureOf({.1, .1, .1, .4, .4, .4, .4, .1, .7, .7, .1, .1, .1, .1, .1, .1, .4, .9, .4, .4});
  EXPECT_EQ(joint.samples[Index(LoadClass::kLow)], 10U);
  EXPECT_EQ(joint.samples[Index(LoadClass::kMedium)], 7U);
  EXPECT_EQ(joint.samples[Index(LoadClass::kHigh)], 3U);
  EXPECT_NEAR(joint.secs[Index(LoadClass::kLow)], 1.0, 1e-9);
  EXPECT_NEAR(joint.secs[Index(LoadClass::kMedium)], 0.7, 1e-9);
  EXPECT_NEAR(joint.secs[Index(LoadClass::kHigh)], 0.3, 1e-9);
  EXPECT_EQ(joint.p10, 0.1);
  EXPECT_EQ(joint.p50, 0.1);
  EXPECT_EQ(joint.p90, 0.7);
  EXPECT_NEAR(joint.above[0].longest_secs, 0.4, 1e-9);
  EXPECT_NEAR(joint.above[1].longest_secs, 0.2, 1e-9);
  EXPECT_EQ(joint.above[0].rises, 3U);
  EXPECT_EQ(joint.above[1].rises, 2U);
  EXPECT_NEAR(joint.above[0].rises_per_min, 90, 1e-9);
  EXPECT_NEAR(joint.above[1].rises_per_min, 60, 1e-9);
  EXPECT_EQ(joint.peak_ratio, 0.9);
  EXPECT_EQ(joint.peak_moment, 90);
  EXPECT_EQ(joint.peak_capacity, 100);
  EXPECT_EQ(joint.peak_channel, "flexion");
  EXPECT_EQ(joint.peak_stamp_nanos, 1700 * kNanosPerMilli);
}

TEST(Exposure, CountsARatioAtALimitToTheLowerBand) {
  const JointExposure joint = ExposureOf({.3, .3, .6, .6});
  EXPECT_EQ(joint.samples[Index(LoadClass::kLow)], 2U);
  EXPECT_EQ(joint.samples[Index(LoadClass::kMedium)], 2U);
  EXPECT_EQ(joint.samples[Index(LoadClass::kHigh)], 0U);
}

TEST(Exposure, UsesPercentilesOfTheNearestRank) {
  std::vector<double> one_of_ten(10, 0.0);
  one_of_ten[4] = 1.2;
  EXPECT_EQ(ExposureOf(one_of_ten).p90, 0);
  std::vector<double> three_of_twenty(20, 0.0);
  three_of_twenty[1] = three_of_twenty[7] = three_of_twenty[19] = 1;
  EXPECT_EQ(ExposureOf(three_of_twenty).p90, 1);
  const JointExposure one = ExposureOf({0.42});
  EXPECT_EQ(one.p10, 0.42);
  EXPECT_EQ(one.p90, 0.42);
}

// "p90 above the limit" and "more than 10 % of the samples above the limit" are one statement.
TEST(Exposure, PercentilesAgreeWithSharesOfSamples) {
  Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<double> ratios;
    for (int i = 0; i < 3 + trial; ++i) ratios.push_back(std::pow(random.Number(1), 2) * 1.5);
    const JointExposure joint = ExposureOf(ratios);
    const auto high = joint.samples[Index(LoadClass::kHigh)];
    EXPECT_EQ(joint.p90 > 0.6, 10 * high > ratios.size()) << trial;
    std::sort(ratios.begin(), ratios.end());
    EXPECT_EQ(joint.p50, ratios[(ratios.size() + 1) / 2 - 1]);
  }
}

TEST(Exposure, ExcludesUnknownSamplesFromPercentilesAndRates) {
  const JointExposure joint =
      ExposureOf({kUnknownRatio, .1, kUnknownRatio, .7, kUnknownRatio, .1, .7, .7, .1, .1});
  EXPECT_EQ(joint.samples[Index(LoadClass::kUnknown)], 3U);
  EXPECT_EQ(joint.p50, .1);
  EXPECT_NEAR(joint.above[1].longest_secs, 0.2, 1e-9);
  EXPECT_EQ(joint.above[1].rises, 1U) << "nothing is known about how the first one began";
  EXPECT_NEAR(joint.above[1].rises_per_min, 60 / 0.7, 1e-9);
  const JointExposure never = ExposureOf({kUnknownRatio, kUnknownRatio});
  EXPECT_TRUE(std::isnan(never.p50));
  EXPECT_TRUE(std::isnan(never.peak_ratio));
  EXPECT_TRUE(std::isnan(never.above[0].rises_per_min));
  EXPECT_NEAR(never.secs[0], 0.2, 1e-9);
}

TEST(Exposure, CountsATremblingRatioAsOneRise) {
  const JointExposure joint = ExposureOf({.5, .61, .59, .61, .56, .62, .54, .61});
  EXPECT_EQ(joint.above[1].rises, 2U);
  EXPECT_EQ(joint.samples[Index(LoadClass::kHigh)], 4U) << "shares have no hysteresis";
}

TEST(Exposure, EndsHoldsAtGapsAndBackwardSteps) {
  Exposure exposure;
  for (const std::int64_t millis : {0, 100, 200, 3'600'000, 3'600'100, 50, 150}) {
    exposure.Add(LoadsOf(0.9), millis * kNanosPerMilli);
  }
  exposure.Finish();
  EXPECT_EQ(exposure.samples(), 7U);
  EXPECT_NEAR(exposure.secs(), 0.7, 1e-9) << "each sample counts for a tenth of a second";
  EXPECT_NEAR(exposure.Of(0).above[1].longest_secs, 0.3, 1e-9);
}

TEST(BandTimes, CountTheTimeInEachBandUpToTheNewestSample) {
  BandTimes times;
  const auto add = [&](double ratio, std::int64_t millis) {
    std::array<JointLoad, urdf::kScoredJointCount> loads;
    const std::vector<JointLoad> all = LoadsOf(ratio);
    std::copy(all.begin(), all.end(), loads.begin());
    times.Add(loads, millis * kNanosPerMilli);
  };
  add(0.1, 0);
  add(0.4, 300);
  add(0.7, 400);
  add(kUnknownRatio, 450);
  add(0.1, 650);
  EXPECT_NEAR(times.SecsOf(3)[Index(LoadClass::kLow)], 0.3, 1e-9);
  EXPECT_NEAR(times.SecsOf(3)[Index(LoadClass::kMedium)], 0.1, 1e-9);
  EXPECT_NEAR(times.SecsOf(3)[Index(LoadClass::kHigh)], 0.05, 1e-9);
  EXPECT_NEAR(times.SecsOf(3)[Index(LoadClass::kUnknown)], 0.2, 1e-9);
}

}  // namespace
}  // namespace kinescope::loads::testing
