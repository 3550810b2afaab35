#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/system/errors.h"
#include "server/subject/subject.h"

namespace kinescope::subject {
namespace {

struct Collected final : SampleSink {
  void OnCharacter(const Character& character) override { characters.push_back(character); }
  void OnSample(const BodySample& sample) override {
    EXPECT_FALSE(characters.empty()) << "a sample before its character";
    samples.push_back(sample);
  }
  std::vector<Character> characters;
  std::vector<BodySample> samples;
};

TEST(SubjectSource, DeliversSamplesOneByOneAndEndsAfterItsDuration) {
  const auto source = OpenSubject("lift", 240, 0.5);
  Collected sink;
  while (source->Poll(std::chrono::milliseconds(0), sink) == Source::State::kMore) {
    ASSERT_LE(sink.samples.size(), 120u);
    ASSERT_EQ(source->counters().samples, sink.samples.size());
  }
  ASSERT_EQ(sink.samples.size(), 120u);
  EXPECT_EQ(source->Poll(std::chrono::milliseconds(0), sink), Source::State::kEnded);
  EXPECT_EQ(sink.samples.size(), 120u);

  ASSERT_EQ(sink.characters.size(), 1u);
  EXPECT_EQ(sink.characters[0].name, "Demo");
  EXPECT_EQ(sink.characters[0].skeleton, urdf::DefaultSkeleton());
  EXPECT_FALSE(source->is_live());
  EXPECT_EQ(source->description(), "demo:lift");
  EXPECT_EQ(source->nominal_rate_hz(), 240);
}

TEST(SubjectSource, CountsSamplesAndGivesThemTimeStampsFromItsEpoch) {
  const auto source = OpenSubject("walk", 60, 0);
  Collected sink;
  for (int i = 0; i < 600; ++i) {
    ASSERT_NE(source->Poll(std::chrono::milliseconds(0), sink), Source::State::kEnded);
  }
  const std::int64_t epoch = sink.samples[0].stamp_nanos;
  EXPECT_EQ(epoch, 1'577'836'800'000'000'000);
  for (std::size_t i = 0; i < sink.samples.size(); ++i) {
    const BodySample& sample = sink.samples[i];
    const double seconds = static_cast<double>(i) / 60;
    EXPECT_EQ(sample.counter, i);
    EXPECT_EQ(sample.stamp_nanos - epoch, std::llround(seconds * 1e9));
    EXPECT_EQ(sample.time_code_millis, std::llround(seconds * 1e3));
    EXPECT_EQ(sample.arrival_nanos, 0);
  }
}

TEST(SubjectSource, RejectsInvalidRatesDurationsAndMotions) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double rate : {0.0, -60.0, 1e9, nan}) {
    EXPECT_THROW(OpenSubject("lift", rate, 1), SourceError) << rate;
  }
  for (const double seconds : {-1.0, 1e300, nan}) {
    EXPECT_THROW(OpenSubject("lift", 60, seconds), SourceError) << seconds;
  }
  EXPECT_THROW(OpenSubject("jump", 60, 1), SourceError);
}

}  // namespace
}  // namespace kinescope::subject
