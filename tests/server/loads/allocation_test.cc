// Loads allocate nothing per sample. A program of its own, since it counts every allocation of the
// process.
#include "server/loads/exposure.h"
#include "server/subject/subject.h"
#include "tests/allocations.h"
#include "tests/server/loads/loads_testing.h"

namespace kinescope::loads::testing {
namespace {

TEST(Loads, AllocateNothingPerSampleForAnyMetric) {
  std::vector<BodySample> samples;
  std::vector<LinkPoses> links(120);
  const auto motion = subject::MakeMotion("walk");
  for (std::size_t i = 0; i < links.size(); ++i) {
    samples.push_back(motion->At(static_cast<double>(i) / 60));
    links[i] = LinkPosesOf(samples[i]);
  }
  for (const LoadMetric metric :
       {LoadMetric::kTotal, LoadMetric::kOverload, LoadMetric::kExternal, LoadMetric::kNorm}) {
    LoadSettings settings;
    settings.metric = metric;
    settings.hands = Held(5, 2);
    settings.hands.both_kg = 3;
    settings.strength.percentile = Percentile::k5;
    Measurements measured;
    measured.hands[kLeft].emplace().force = {10, 0, 0};
    LoadEstimator estimator;
    BandTimes exposure;
    estimator.Update(samples[0], links[0], {Person(), Body()}, settings, measured);
    const std::size_t before = kinescope::testing::Allocations();
    for (std::size_t i = 1; i < samples.size(); ++i) {
      measured.hands[kLeft]->stamp_nanos = samples[i].stamp_nanos;
      if (i % 7 == 0) samples[i].segments[3].position.x() = std::nan("");
      const LoadResult& result =
          estimator.Update(samples[i], links[i], {Person(), Body()}, settings, measured);
      exposure.Add(result.loads, samples[i].stamp_nanos);
    }
    EXPECT_EQ(kinescope::testing::Allocations() - before, 0U) << Name(metric);
  }
}

}  // namespace
}  // namespace kinescope::loads::testing
