// What the input path costs: datagrams decoded and joined to samples, and a sample made into a
// scene (link poses, angles, static loads, classes), and an MVNX file. No socket.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "server/mvn/assembler.h"
#include "server/mvn/encode.h"
#include "server/mvn/file/mvnx_source.h"
#include "server/scene/scene_builder.h"
#include "server/subject/subject.h"
#include "tests/server/mvn/file/synthetic_mvnx.h"
#include "tests/server/mvn/mvn_testing.h"

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

// A second of a stream, sent over and over: the header of each datagram moves on with every round.
class EndlessStream {
 public:
  EndlessStream(int people, const mvn::TypeSet& types, bool full) {
    mvn::testing::RandomValues random(1);
    const urdf::Skeleton skeleton = urdf::DefaultSkeleton();
    for (const BodySample& of_subject : Samples()) {
      for (int person = 0; person < people; ++person) {
        BodySample sample = of_subject;
        sample.time_code_millis = sample.counter * 1000 / kRateHz;
        sample.character = person;
        if (full) {
          const BodySample random_sample = mvn::testing::RandomFullSample(random, sample.counter);
          sample.fingers_and_props = random_sample.fingers_and_props;
          sample.streamed_angles_deg = random_sample.streamed_angles_deg;
        }
        for (std::string& datagram :
             mvn::EncodeSample(sample, types, urdf::LandmarksOf(skeleton))) {
          datagrams_.push_back(
              {sample.counter, sample.counter * 1000 / kRateHz, std::move(datagram)});
        }
      }
    }
  }

  std::size_t size() const { return datagrams_.size(); }

  /// The next datagram; valid until the next call.
  const std::string& Next() {
    if (next_ == datagrams_.size()) {
      next_ = 0;
      ++round_;
    }
    Datagram& datagram = datagrams_[next_++];
    mvn::HeaderPatch patch;
    patch.sample_counter = datagram.counter + round_ * kSamples;
    patch.time_code_millis = datagram.millis + round_ * 1000;
    mvn::PatchHeader(patch, datagram.bytes);
    return datagram.bytes;
  }

 private:
  struct Datagram {
    std::uint32_t counter;
    std::uint32_t millis;
    std::string bytes;
  };

  std::vector<Datagram> datagrams_;
  std::size_t next_ = 0;
  std::uint32_t round_ = 0;
};

const mvn::TypeSet& EveryType() {
  using mvn::Type;
  static const mvn::TypeSet types = mvn::MakeTypeSet(
      {Type::kEulerPose, Type::kPose, Type::kMarkers, Type::kJointAngles, Type::kLinear,
       Type::kAngular, Type::kTrackers, Type::kCenterOfMass, Type::kTimeCode});
  return types;
}

void RefuseLosses(const mvn::Assembler& assembler, benchmark::State& run) {
  const SourceCounters counters = assembler.counters();
  if (counters.late + counters.restarts + counters.incomplete + counters.outliers > 0) {
    run.SkipWithError("samples lost");
  }
}

void DecodeAndJoin(benchmark::State& run) {
  EndlessStream stream(1, mvn::UsualTypes(), false);
  mvn::Assembler assembler;
  Nothing sink;
  const std::int64_t step = 1'000'000'000 / static_cast<std::int64_t>(stream.size());
  mvn::Arrival arrival{};
  for (auto _ : run) {
    assembler.Add({}, stream.Next(), arrival, sink);
    arrival.monotonic_nanos += step;
    arrival.wall_nanos += step;
  }
  RefuseLosses(assembler, run);
  run.counters["datagrams/s"] =
      benchmark::Counter(static_cast<double>(run.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(DecodeAndJoin);

// One datagram at a time, by the clock: the slowest of them are those that end a sample.
void DecodeAndJoinLatency(benchmark::State& run) {
  EndlessStream stream(1, mvn::UsualTypes(), false);
  mvn::Assembler assembler;
  Nothing sink;
  const std::int64_t step = 1'000'000'000 / static_cast<std::int64_t>(stream.size());
  mvn::Arrival arrival{};
  std::vector<double> micros;
  for (auto _ : run) {
    const std::string& datagram = stream.Next();
    const auto start = std::chrono::steady_clock::now();
    assembler.Add({}, datagram, arrival, sink);
    const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - start;
    micros.push_back(took.count());
    arrival.monotonic_nanos += step;
    arrival.wall_nanos += step;
  }
  RefuseLosses(assembler, run);
  std::sort(micros.begin(), micros.end());
  const auto at = [&](double share) {
    return micros[static_cast<std::size_t>(share * static_cast<double>(micros.size() - 1))];
  };
  run.counters["p50_us"] = at(0.5);
  run.counters["p99_us"] = at(0.99);
  run.counters["p999_us"] = at(0.999);
}
BENCHMARK(DecodeAndJoinLatency)->Iterations(200'000);

// A second of four people at 240 Hz with all types, gloves and props: the share of a core that it
// takes is the time of one iteration.
void FourPeopleEveryType(benchmark::State& run) {
  EndlessStream stream(4, EveryType(), true);
  mvn::Assembler assembler;
  Nothing sink;
  const std::int64_t step = 1'000'000'000 / static_cast<std::int64_t>(stream.size());
  mvn::Arrival arrival{};
  for (auto _ : run) {
    for (std::size_t i = 0; i < stream.size(); ++i) {
      assembler.Add({}, stream.Next(), arrival, sink);
      arrival.monotonic_nanos += step;
      arrival.wall_nanos += step;
    }
  }
  RefuseLosses(assembler, run);
}
BENCHMARK(FourPeopleEveryType)->Unit(benchmark::kMillisecond);

void SampleToScene(benchmark::State& run) {
  const std::vector<BodySample> samples = Samples();
  app::SceneOptions options;
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
