// All that is computed about forces, for one person and one sample.
#include <benchmark/benchmark.h>

#include <vector>

#include "server/loads/exposure.h"
#include "server/loads/load_estimator.h"
#include "server/subject/subject.h"

namespace kinescope::loads {
namespace {

constexpr int kRateHz = 240;

struct Recorded {
  std::vector<BodySample> samples;
  std::vector<urdf::LinkPoses> links;
};

// Two whole laps: the last sample is where the first one is.
const Recorded& Walk() {
  static const Recorded walk = [] {
    Recorded recorded;
    const auto motion = subject::MakeMotion("walk");
    for (int i = 0; i < 10 * kRateHz; ++i) {
      recorded.samples.push_back(motion->At(static_cast<double>(i) / kRateHz));
      recorded.links.push_back(LinkPosesOf(recorded.samples.back()));
    }
    return recorded;
  }();
  return walk;
}

void Run(benchmark::State& run, LoadMetric metric) {
  const Recorded& walk = Walk();
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton();
  const urdf::BodyParameters body = urdf::MakeBodyParameters({}, skeleton);
  LoadSettings settings;
  settings.metric = metric;
  settings.hands.is_known = true;
  settings.hands.mass_kg = {5, 2};
  settings.hands.both_kg = 3;
  LoadEstimator estimator;
  BandTimes exposure;
  std::size_t next = 0;
  std::int64_t stamp = 0;
  for (auto _ : run) {
    BodySample sample = walk.samples[next];
    sample.stamp_nanos = stamp += 1'000'000'000 / kRateHz;
    const LoadResult& result =
        estimator.Update(sample, walk.links[next], {skeleton, body}, settings);
    exposure.Add(result.loads, stamp);
    benchmark::DoNotOptimize(result.loads[0].ratio);
    if (++next == walk.samples.size()) next = 0;
  }
}

void LoadsOfASample(benchmark::State& run) { Run(run, LoadMetric::kTotal); }
BENCHMARK(LoadsOfASample)->Unit(benchmark::kMicrosecond);

void OverloadsOfASample(benchmark::State& run) { Run(run, LoadMetric::kOverload); }  // two solves
BENCHMARK(OverloadsOfASample)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace kinescope::loads
