#include "server/scene/sample_smoother.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "server/subject/subject.h"

namespace kinescope::app {
namespace {

struct Order : SmoothSampleSink {
  void OnCharacter(const Character&) override {}
  void OnSample(const BodySample&, const loads::BodyMotion*) override { ++samples; }
  void OnObjects(const ObjectsSample&) override {}
  void OnSurroundings(const RecordedSurroundings&) override {}
  void OnMoment(const SourceMoment&) override { samples_before.push_back(samples); }

  int samples = 0;
  std::vector<int> samples_before;  // of each moment
};

// What a bag has beside people who have left would else wait in memory up to its end.
TEST(SampleSmoother, KeepsNothingOfPeopleWhoHaveLeft) {
  Order order;
  SampleSmoother smoother(6, order);
  const auto lift = subject::MakeMotion("lift");
  BodySample sample;
  for (int i = 0; i < 30; ++i) {
    sample = lift->At(i / 60.0);
    sample.stamp_nanos = std::llround(1e9 * (1 + i / 60.0));
    smoother.OnSample(sample);
  }
  EXPECT_LT(order.samples, 30) << "the filter needs those that follow";
  smoother.OnMoment({sample.stamp_nanos + 10'000'000, 0});
  EXPECT_TRUE(order.samples_before.empty()) << "they have not left";
  smoother.OnMoment({sample.stamp_nanos + 1'100'000'000, 0});
  EXPECT_EQ(order.samples_before, (std::vector<int>{30, 30}));
  sample.stamp_nanos += 2'000'000'000;
  smoother.OnSample(sample);
  smoother.End();
  EXPECT_EQ(order.samples, 31);
}

}  // namespace
}  // namespace kinescope::app
