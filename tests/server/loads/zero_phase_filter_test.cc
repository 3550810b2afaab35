#include "server/loads/zero_phase_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace kinescope::loads {
namespace {

// The x accelerations of the pelvis that come out for those that go in.
std::vector<double> Filtered(const std::vector<double>& values, double rate_hz, double cutoff_hz) {
  ZeroPhaseFilter filter(cutoff_hz);
  std::vector<double> out;
  const auto take = [&] {
    while (!filter.ready().empty()) {
      out.push_back(filter.ready().front()[urdf::kPelvis].acceleration.x());
      filter.ready().pop_front();
    }
  };
  for (std::size_t i = 0; i < values.size(); ++i) {
    BodySample sample;
    sample.stamp_nanos = std::llround(1e9 * static_cast<double>(i) / rate_hz);
    sample.segments[urdf::kPelvis].acceleration = {values[i], 0, 0};
    sample.segments[urdf::kPelvis].angular_acceleration = {1, 0, 0};
    filter.Add(sample);
    take();
  }
  filter.End();
  take();
  return out;
}

// SciPy's filtfilt with butter(2, 6, fs=60): the cut-off that two passes of it have together.
double TwoPassCutoff() { return 60 / M_PI * std::atan(0.8022430 * std::tan(M_PI * 6 / 60)); }

void ExpectVector(const std::vector<double>& in, const std::vector<double>& expected) {
  const std::vector<double> out = Filtered(in, 60, TwoPassCutoff());
  ASSERT_EQ(out.size(), expected.size());
  for (std::size_t i = 0; i < out.size(); ++i) EXPECT_NEAR(out[i], expected[i], 2e-6) << i;
}

// Vectors of biomech-files.md B.1, from SciPy 1.10.1.
TEST(ZeroPhaseFilter, EqualsTheFiltfiltOfSciPy) {
  std::vector<double> impulse(13, 0.0);
  impulse[6] = 1;
  ExpectVector(impulse,
               {-0.0000078, 0.0141135, 0.0382945, 0.0792626, 0.1355112, 0.1902070, 0.2137773,
                0.1899392, 0.1350244, 0.0786976, 0.0379572, 0.0145478, 0.0019916});
  ExpectVector({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11},
               {0.0051566, 1.0071827, 2.0061805, 3.0039837, 4.0014417, 4.9987314, 5.9957906,
                6.9928009, 7.9906907, 8.9915805, 9.9989682, 11.0172635});
  ExpectVector({1, 2, 4, 7, 11, 16, 22, 29, 37, 46, 56, 67},
               {1.0512059, 2.7464505, 4.8179049, 7.6177423, 11.3778381, 16.2246248, 22.2102531,
                29.3350147, 37.5498510, 46.7386759, 56.6907231, 67.0858295});
}

TEST(ZeroPhaseFilter, HasNoLagAndItsCutOffAtTheGivenFrequency) {
  for (const double rate_hz : {60.0, 240.0}) {
    for (const double hz : {1.0, 3.0, 10.0}) {
      std::vector<double> wave;
      for (int i = 0; i < 12 * rate_hz; ++i) wave.push_back(std::sin(2 * M_PI * hz * i / rate_hz));
      const std::vector<double> out = Filtered(wave, rate_hz, 10);
      const double ratio = std::tan(M_PI * hz / rate_hz) / std::tan(M_PI * 10 / rate_hz);
      const double gain = 1 / (1 + (std::sqrt(2.0) - 1) * std::pow(ratio, 4));
      if (hz == 10.0) EXPECT_NEAR(gain, std::sqrt(0.5), 1e-9);
      ASSERT_EQ(out.size(), wave.size());
      const auto n = static_cast<std::size_t>(rate_hz);
      for (std::size_t i = n; i + n < wave.size(); ++i) {
        ASSERT_NEAR(out[i], gain * wave[i], 2e-4) << hz << " Hz at " << rate_hz << ", sample " << i;
      }
    }
  }
}

TEST(ZeroPhaseFilter, GivesOneMotionPerSampleHoweverShortThePieces) {
  for (const std::size_t size : {1U, 2U, 9U, 10U, 11U, 500U}) {
    const std::vector<double> out = Filtered(std::vector<double>(size, 2.5), 120, 10);
    ASSERT_EQ(out.size(), size);
    for (const double value : out) EXPECT_NEAR(value, 2.5, 1e-9) << "of " << size;
  }
}

TEST(ZeroPhaseFilter, DerivesAccelerationsThatAreNotStreamed) {
  ZeroPhaseFilter filter(10);
  for (int i = 0; i < 600; ++i) {
    const double secs = i / 120.0;
    BodySample sample;
    sample.stamp_nanos = std::llround(1e9 * secs);
    sample.segments[urdf::kHead].velocity = {std::sin(4 * secs), 0, 0};
    sample.segments[urdf::kHead].angular_velocity = {0, std::sin(3 * secs), 0};
    filter.Add(sample);
  }
  filter.End();
  ASSERT_EQ(filter.ready().size(), 600U);
  for (int i = 60; i < 540; ++i) {
    const double secs = i / 120.0;
    const SegmentMotion& head = filter.ready()[static_cast<std::size_t>(i)][urdf::kHead];
    EXPECT_NEAR(head.acceleration.x(), 4 * std::cos(4 * secs), 0.01) << i;
    EXPECT_NEAR(head.angular_acceleration.y(), 3 * std::cos(3 * secs), 0.01) << i;
  }
}

}  // namespace
}  // namespace kinescope::loads
