#include "server/loads/load_meter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "core/system/clocks.h"

namespace kinescope::loads {
namespace {

char Letter(LoadClass load_class) { return "?GOR"[static_cast<int>(load_class)]; }

TEST(LoadMeter, FollowsTheReferenceSequenceOfTheHysteresisWithoutDelays) {
  LoadMeter::Settings settings;
  settings.rise_secs = settings.hold_secs = settings.fall_secs = 0;
  LoadMeter meter(settings);
  std::string classes;
  std::int64_t now = 0;
  for (const double ratio : {.10, .29, .31, .27, .24, .61, .58, .54, .20, .70, .50, .20}) {
    const LoadMeter::Reading shown = meter.Update(ratio, now += 10 * kNanosPerMilli);
    EXPECT_DOUBLE_EQ(shown.ratio, ratio);
    classes += Letter(shown.load_class);
  }
  EXPECT_EQ(classes, "GGOOGRROGROG");  // joint-loads.md 4.3
}

// Readings of a ratio that is `before` for a second, `peak` for `peak_millis`, then `after`.
std::vector<LoadMeter::Reading> ReadingsOf(double before, double peak, int peak_millis,
                                           double after, int step_millis) {
  LoadMeter meter;
  std::vector<LoadMeter::Reading> readings;
  for (int now = -1000; now <= 3000; now += step_millis) {
    const double ratio = now < 0 ? before : now < peak_millis ? peak : after;
    const LoadMeter::Reading shown = meter.Update(ratio, now * kNanosPerMilli);
    if (now >= 0) readings.push_back(shown);
  }
  return readings;
}

TEST(LoadMeter, RisesWithinATwentiethOfASecondAndNeverOvershoots) {
  for (const int step : {4, 8, 20}) {
    const auto readings = ReadingsOf(0.1, 0.8, 1000, 0.8, step);
    EXPECT_GT(readings[static_cast<std::size_t>(50 / step)].ratio, 0.1 + 0.63 * 0.7) << step;
    for (const LoadMeter::Reading& shown : readings) EXPECT_LE(shown.ratio, 0.8);
    EXPECT_EQ(readings.back().load_class, LoadClass::kHigh);
  }
}

TEST(LoadMeter, HoldsAPeakForThreeTenthsOfASecondThenFallsAtAnySampleRate) {
  for (const int step : {4, 10, 20}) {
    const auto readings = ReadingsOf(0.1, 0.8, 400, 0.1, step);
    const auto at = [&](int millis) { return readings[static_cast<std::size_t>(millis / step)]; };
    const double peak = at(400 - step).ratio;
    EXPECT_NEAR(peak, 0.8, 1e-3);
    EXPECT_DOUBLE_EQ(at(680).ratio, peak) << step;
    EXPECT_EQ(at(680).load_class, LoadClass::kHigh);
    // 0.3 s after the hold, 1/e of the fall is left.
    EXPECT_NEAR(at(1000).ratio, 0.1 + 0.7 * std::exp(-(300.0 + step) / 300), 2e-3) << step;
    EXPECT_EQ(readings.back().load_class, LoadClass::kLow);
  }
}

TEST(LoadMeter, NeverShowsARatioOutsideItsClassByMoreThanTheHysteresis) {
  std::mt19937 random(7);
  std::normal_distribution<double> step(0, 0.08);
  LoadMeter meter;
  double ratio = 0.3;
  for (int i = 0; i < 100'000; ++i) {
    ratio = std::abs(ratio + step(random));
    if (ratio > 1.2) ratio = 0.2;
    const LoadMeter::Reading shown = meter.Update(ratio, i * 8 * kNanosPerMilli);
    const auto index = static_cast<std::size_t>(shown.load_class);
    const double from[] = {0, 0, 0.25, 0.55}, to[] = {0, 0.30, 0.60, 9};
    ASSERT_NE(index, 0U);
    ASSERT_GE(shown.ratio, from[index]) << i;
    ASSERT_LE(shown.ratio, to[index]) << i;
  }
}

TEST(LoadMeter, ShowsEverySampleAsItIsIfMomentary) {
  LoadMeter::Settings settings;
  settings.is_momentary = true;
  LoadMeter meter(settings);
  std::string classes;
  std::int64_t now = 0;
  for (const double ratio : {.70, .30, .31, .60, .61, .10}) {
    const LoadMeter::Reading shown = meter.Update(ratio, now += 10 * kNanosPerMilli);
    EXPECT_EQ(shown.ratio, ratio);
    classes += Letter(shown.load_class);
  }
  EXPECT_EQ(classes, "RGOORG");
}

TEST(LoadMeter, ReportsMissingDataAsUnknownAndRestartsAfterwards) {
  LoadMeter meter;
  EXPECT_EQ(meter.Update(0.9, 0).load_class, LoadClass::kHigh);
  const LoadMeter::Reading unknown = meter.Update(std::nan(""), 10 * kNanosPerMilli);
  EXPECT_EQ(unknown.load_class, LoadClass::kUnknown);
  EXPECT_TRUE(std::isnan(unknown.ratio));
  EXPECT_EQ(meter.Update(0.1, 20 * kNanosPerMilli).load_class, LoadClass::kLow);
  EXPECT_EQ(meter.Update(0.1, 30 * kNanosPerMilli).ratio, 0.1);
}

TEST(LoadMeter, RestartsAfterAGapOrABackwardTimeStep) {
  LoadMeter meter;
  EXPECT_EQ(meter.Update(0.9, 0).load_class, LoadClass::kHigh);
  EXPECT_EQ(meter.Update(0.1, 600 * kNanosPerMilli).load_class, LoadClass::kLow);
  EXPECT_EQ(meter.Update(0.9, 100 * kNanosPerMilli).load_class, LoadClass::kHigh);
}

}  // namespace
}  // namespace kinescope::loads
