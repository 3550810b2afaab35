// Loads allocate nothing per sample. A program of its own, since it counts every allocation of the
// process.
#include <cstdlib>
#include <new>

#include "server/loads/exposure.h"
#include "server/subject/subject.h"
#include "tests/server/loads/loads_testing.h"

namespace {

std::size_t allocations = 0;

}  // namespace

void* operator new(std::size_t size) {
  ++allocations;
  if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  ++allocations;
  const auto to = static_cast<std::size_t>(alignment);
  if (void* const memory = std::aligned_alloc(to, (size + to - 1) / to * to)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace kinescope::loads::testing {
namespace {

TEST(Loads, AllocateNothingPerSampleWhateverIsAsked) {
  std::vector<BodySample> samples;
  std::vector<LinkPoses> links(120);
  const auto motion = subject::MakeMotion("walk");
  for (std::size_t i = 0; i < links.size(); ++i) {
    samples.push_back(motion->At(static_cast<double>(i) / 60));
    for (int segment = 0; segment < kSegmentCount; ++segment) {
      const SegmentState& state = samples[i].segments[urdf::At(segment)];
      links[i][urdf::At(segment)] = {state.position, state.orientation * SegmentFromLink(segment)};
    }
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
    Exposure exposure;
    estimator.Update(samples[0], links[0], {Person(), Body()}, settings, measured);
    const std::size_t before = allocations;
    for (std::size_t i = 1; i < samples.size(); ++i) {
      measured.hands[kLeft]->stamp_nanos = samples[i].stamp_nanos;
      if (i % 7 == 0) samples[i].segments[3].position.x() = std::nan("");
      const LoadResult& result =
          estimator.Update(samples[i], links[i], {Person(), Body()}, settings, measured);
      exposure.Add(result.loads, samples[i].stamp_nanos);
    }
    EXPECT_EQ(allocations - before, 0U) << Name(metric);
  }
}

}  // namespace
}  // namespace kinescope::loads::testing
