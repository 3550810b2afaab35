#include "server/app/paced_source.h"

#include <gtest/gtest.h>

#include <vector>

#include "server/app/clocks.h"

namespace kinescope::app {
namespace {

using std::chrono::milliseconds;

// Three samples, 2 ms apart, with the stamps of an old recording.
class ShortFile : public Source {
 public:
  State Poll(milliseconds, SampleSink& sink) override {
    if (next_ == 0) sink.OnCharacter({});
    if (next_ == 3) return State::kEnded;
    BodySample sample;
    sample.counter = static_cast<std::uint32_t>(next_);
    sample.time_code_millis = 2 * next_;
    sample.stamp_nanos = 1'000'000'000 + 2'000'000 * next_;
    ++next_;
    sink.OnSample(sample);
    return State::kMore;
  }
  SourceCounters counters() const override { return {}; }
  std::string description() const override { return "short"; }
  bool is_live() const override { return false; }
  double nominal_rate_hz() const override { return 500; }

 private:
  int next_ = 0;
};

struct Collector : SampleSink {
  void OnCharacter(const Character&) override { ++characters; }
  void OnSample(const BodySample& sample) override { samples.push_back(sample); }
  int characters = 0;
  std::vector<BodySample> samples;
};

TEST(PacedSource, GivesEverySampleOnceNotBeforeItIsDue) {
  PacedSource source([] { return std::make_unique<ShortFile>(); }, false);
  Collector collector;
  const std::int64_t before = MonotonicNanos();
  const std::int64_t wall_before = WallNanos();
  while (source.Poll(milliseconds(1000), collector) == Source::State::kMore) {
  }
  ASSERT_EQ(collector.samples.size(), 3u);
  EXPECT_GE(MonotonicNanos() - before, 4'000'000) << "played faster than it was recorded";
  EXPECT_GE(collector.samples[0].stamp_nanos, wall_before) << "stamps are of today";
  for (int i = 1; i < 3; ++i) {
    const auto index = static_cast<std::size_t>(i);
    EXPECT_EQ(collector.samples[index].stamp_nanos - collector.samples[0].stamp_nanos,
              2'000'000 * i);
    EXPECT_GE(collector.samples[index].arrival_nanos - collector.samples[0].arrival_nanos,
              2'000'000 * i - 200'000);
  }
}

TEST(PacedSource, ReturnsWithoutASampleWhenTheTimeoutIsShorter) {
  PacedSource source([] { return std::make_unique<ShortFile>(); }, false);
  Collector collector;
  source.Poll(milliseconds(1000), collector);
  ASSERT_EQ(collector.samples.size(), 1u);
  EXPECT_EQ(source.Poll(milliseconds(0), collector), Source::State::kMore);
}

TEST(PacedSource, LoopsWithCounterAndTimeGoingOn) {
  PacedSource source([] { return std::make_unique<ShortFile>(); }, true);
  Collector collector;
  while (collector.samples.size() < 7) source.Poll(milliseconds(1000), collector);
  EXPECT_EQ(collector.characters, 3);
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_EQ(collector.samples[i].counter, i);
    EXPECT_EQ(collector.samples[i].stamp_nanos - collector.samples[0].stamp_nanos,
              static_cast<std::int64_t>(2'000'000 * i));
    EXPECT_EQ(collector.samples[i].time_code_millis, static_cast<std::int64_t>(2 * i));
  }
}

}  // namespace
}  // namespace kinescope::app
