#include "server/loads/exposure.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "tests/server/loads/loads_testing.h"

namespace kinescope::loads::testing {
namespace {

constexpr std::int64_t kMillis = 1'000'000;

std::array<JointLoad, 15> LoadsOf(double ratio, LoadClass load_class) {
  std::array<JointLoad, 15> loads;
  for (JointLoad& load : loads) {
    load.ratio = ratio;
    load.load_class = load_class;
    load.deciding_moment = 100 * ratio;
    load.capacity = 100;
    load.channel = "flexion";
  }
  return loads;
}

TEST(Exposure, CountsTheTimeInEachClassUpToTheNextSample) {
  Exposure exposure;
  exposure.Add(LoadsOf(0.1, LoadClass::kLow), 0);
  exposure.Add(LoadsOf(0.4, LoadClass::kMedium), 300 * kMillis);
  exposure.Add(LoadsOf(0.7, LoadClass::kHigh), 400 * kMillis);
  exposure.Add(LoadsOf(std::nan(""), LoadClass::kUnknown), 450 * kMillis);
  exposure.Add(LoadsOf(0.1, LoadClass::kLow), 650 * kMillis);
  const JointExposure joint = exposure.Of(3);
  EXPECT_NEAR(joint.secs[static_cast<std::size_t>(LoadClass::kLow)], 0.3, 1e-9);
  EXPECT_NEAR(joint.secs[static_cast<std::size_t>(LoadClass::kMedium)], 0.1, 1e-9);
  EXPECT_NEAR(joint.secs[static_cast<std::size_t>(LoadClass::kHigh)], 0.05, 1e-9);
  EXPECT_NEAR(joint.secs[static_cast<std::size_t>(LoadClass::kUnknown)], 0.2, 1e-9);
  EXPECT_NEAR(exposure.secs(), 0.65, 1e-9);
  EXPECT_EQ(joint.peak_ratio, 0.7);
  EXPECT_EQ(joint.peak_moment, 70);
  EXPECT_EQ(joint.peak_capacity, 100);
  EXPECT_EQ(joint.peak_channel, "flexion");
  EXPECT_EQ(joint.peak_stamp_nanos, 400 * kMillis);
}

TEST(Exposure, ComputesPercentilesOfTheWholeTrialWithinHalfABin) {
  Random random(1);
  Exposure exposure;
  std::vector<double> ratios;
  for (int i = 0; i <= 10'000; ++i) {
    const double ratio = std::pow(random.Number(1), 2) * 1.5;
    exposure.Add(LoadsOf(ratio, LoadClass::kLow), i * 10 * kMillis);
    if (i < 10'000) ratios.push_back(ratio);  // the last one lasts for no time
  }
  std::sort(ratios.begin(), ratios.end());
  const JointExposure joint = exposure.Of(0);
  EXPECT_NEAR(joint.p10, ratios[1000], kExposureBin / 2 + 1e-3);
  EXPECT_NEAR(joint.p50, ratios[5000], kExposureBin / 2 + 1e-3);
  EXPECT_NEAR(joint.p90, ratios[9000], kExposureBin / 2 + 1e-3);
}

TEST(Exposure, ReportsUnknownLoadsAsNaNInsteadOfZero) {
  Exposure exposure;
  EXPECT_TRUE(std::isnan(exposure.Of(0).p50));
  for (int i = 0; i < 10; ++i) {
    exposure.Add(LoadsOf(std::nan(""), LoadClass::kUnknown), i * 100 * kMillis);
  }
  EXPECT_TRUE(std::isnan(exposure.Of(0).p50));
  EXPECT_TRUE(std::isnan(exposure.Of(0).peak_ratio));
  EXPECT_NEAR(exposure.Of(0).secs[0], 0.9, 1e-9);
}

TEST(Exposure, IgnoresGapsAndBackwardTimeSteps) {
  Exposure exposure;
  exposure.Add(LoadsOf(0.1, LoadClass::kLow), 0);
  exposure.Add(LoadsOf(0.1, LoadClass::kLow), 3'600'000 * kMillis);
  EXPECT_NEAR(exposure.secs(), 0.5, 1e-9);
  exposure.Add(LoadsOf(0.1, LoadClass::kLow), 0);
  EXPECT_NEAR(exposure.secs(), 0.5, 1e-9);
}

TEST(Exposure, LimitsPercentilesToItsScaleButNotThePeak) {
  Exposure exposure;
  exposure.Add(LoadsOf(17, LoadClass::kHigh), 0);
  exposure.Add(LoadsOf(17, LoadClass::kHigh), 100 * kMillis);
  EXPECT_EQ(exposure.Of(0).p50, kExposureMost);
  EXPECT_EQ(exposure.Of(0).peak_ratio, 17);
}

}  // namespace
}  // namespace kinescope::loads::testing
