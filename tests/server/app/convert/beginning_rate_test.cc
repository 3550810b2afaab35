#include "server/app/convert/beginning_rate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "server/app/convert/frame_index.h"

namespace kinescope::app {
namespace {

// Sample `k` of a suit of 240 Hz that sends at `stream_hz`.
BodySample SampleAt(int k, double stream_hz) {
  BodySample sample;
  sample.counter = static_cast<std::uint32_t>(std::floor(k * 240 / stream_hz));
  sample.time_code_millis = std::llround(sample.counter * 1000.0 / 240);
  sample.stamp_nanos = sample.time_code_millis * 1'000'000;
  return sample;
}

TEST(BeginningRate, KnowsARateThatDoesNotDivideThatOfTheSuit) {
  for (const double stream_hz : {240.0, 120.0, 100.0, 60.0, 50.0}) {
    BeginningRate rate;
    for (int k = 0; k < stream_hz; ++k) rate.Add(SampleAt(k, stream_hz));
    EXPECT_NEAR(rate.counter_step(), 240 / stream_hz, 0.03);
    EXPECT_EQ(rate.rate_hz(), stream_hz);
  }
}

TEST(BeginningRate, CountsMissingSamples) {
  BeginningRate rate;
  for (int k = 0; k < 60; ++k) {
    if (k < 20 || k >= 30) rate.Add(SampleAt(k, 60));
  }
  EXPECT_EQ(rate.counter_step(), 4);
  EXPECT_EQ(rate.rate_hz(), 60);
}

TEST(BeginningRate, IsZeroForASingleSample) {
  BeginningRate rate;
  EXPECT_EQ(rate.rate_hz(), 0);
  rate.Add(SampleAt(0, 60));
  EXPECT_EQ(rate.rate_hz(), 0);
  EXPECT_EQ(rate.counter_step(), 1);
}

TEST(FrameIndex, HasNoHolesWhereStepsAlternateAndFindsThoseOfLostSamples) {
  FrameIndex whole(100, 2.4), holed(100, 2.4);
  for (int k = 0; k < 1000; ++k) {
    ASSERT_EQ(whole.Next(SampleAt(k, 100)), k);
    if (k < 500 || k >= 510) {
      ASSERT_EQ(holed.Next(SampleAt(k, 100)), k);
    }
  }
  EXPECT_EQ(whole.holes(), 0U);
  EXPECT_EQ(holed.holes(), 1U);
  EXPECT_EQ(holed.missing_frames(), 10U);
}

}  // namespace
}  // namespace kinescope::app
