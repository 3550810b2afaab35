// What the input path costs: datagrams decoded and joined to samples, and a sample made into a
// scene (link poses, angles, static loads, classes), and an MVNX file. No socket.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "server/app/scene_builder.h"
#include "server/mvn/assembler.h"
#include "server/mvn/encode.h"
#include "server/mvn/file/mvnx_source.h"
#include "server/subject/subject.h"
#include "tests/server/mvn/file/synthetic_mvnx.h"

namespace kinescope {
namespace {

constexpr int kRateHz = 240;
constexpr int kSamples = kRateHz;  // a second of the lift, over and over

struct Nothing : SampleSink {
  void OnCharacter(const Character&) override {}
  void OnSample(const BodySample& sample) override { benchmark::DoNotOptimize(&sample); }
};

std::vector<BodySample> Samples() {
  const auto motion = subject::MakeMotion("lift");
  std::vector<BodySample> samples;
  for (int i = 0; i < kSamples; ++i) {
    samples.push_back(motion->At(static_cast<double>(i) / kRateHz));
    samples.back().counter = static_cast<std::uint32_t>(i);
  }
  return samples;
}

// The sample counter in a datagram's header, big-endian: mvn-protocol.md 1.
void AddToCounter(std::string& datagram, std::uint32_t step) {
  std::uint32_t counter = 0;
  for (std::size_t i = 6; i < 10; ++i)
    counter = counter << 8 | static_cast<std::uint8_t>(datagram[i]);
  counter += step;
  for (std::size_t i = 10; i-- > 6; counter >>= 8) datagram[i] = static_cast<char>(counter & 0xff);
}

void DecodeAndJoin(benchmark::State& run) {
  std::vector<std::string> datagrams;
  for (const BodySample& sample : Samples()) {
    for (std::string& datagram : mvn::EncodeSample(sample))
      datagrams.push_back(std::move(datagram));
  }
  mvn::Assembler assembler;
  Nothing sink;
  mvn::Arrival arrival{};
  std::size_t next = 0;
  for (auto _ : run) {
    assembler.Add({}, datagrams[next], arrival, sink);
    arrival.monotonic_nanos += 800'000;
    arrival.wall_nanos += 800'000;
    AddToCounter(datagrams[next], kSamples);  // for the next round: the stream goes on
    if (++next == datagrams.size()) next = 0;
  }
  const SourceCounters counters = assembler.counters();
  if (counters.late + counters.restarts + counters.incomplete > 0)
    run.SkipWithError("samples lost");
  run.counters["datagrams/s"] =
      benchmark::Counter(static_cast<double>(run.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(DecodeAndJoin);

void SampleToScene(benchmark::State& run) {
  const std::vector<BodySample> samples = Samples();
  app::SceneOptions options;
  options.smooth_figure = false;
  app::SceneBuilder builder(options, "", kRateHz,
                            [](const auto& state) { benchmark::DoNotOptimize(state.get()); });
  std::size_t next = 0;
  std::int64_t stamp = 0;
  for (auto _ : run) {
    BodySample sample = samples[next];
    sample.stamp_nanos = stamp += 1'000'000'000 / kRateHz;
    builder.OnSample(sample);
    if (++next == samples.size()) next = 0;
  }
}
BENCHMARK(SampleToScene)->Unit(benchmark::kMicrosecond);

// A minute and a half at 240 Hz, as long as its text fits the cache of nobody.
void ReadMvnx(benchmark::State& run) {
  constexpr int kFrames = 20'000;
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton();
  std::string text =
      mvn::testing::WriteMvnx(4, kRateHz, skeleton, mvn::testing::SwingingArms(skeleton, kFrames));
  Nothing sink;
  for (auto _ : run) {
    mvn::MvnxSource source(fmemopen(text.data(), text.size(), "rb"), "bench.mvnx");
    while (source.Poll({}, sink) == Source::State::kMore) {
    }
    if (source.counters().samples != kFrames) run.SkipWithError("frames lost");
  }
  run.SetBytesProcessed(static_cast<std::int64_t>(run.iterations() * text.size()));
}
BENCHMARK(ReadMvnx)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace kinescope
