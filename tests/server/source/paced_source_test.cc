#include "server/source/paced_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/system/clocks.h"
#include "core/system/errors.h"

namespace kinescope::app {
namespace {

using std::chrono::milliseconds;
using ::testing::ElementsAre;

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

// Three moments without a person, 2 ms apart, and what is new with the second.
class FileWithoutPeople : public Source {
 public:
  State Poll(milliseconds, SampleSink& sink) override {
    if (next_ == 3) return State::kEnded;
    if (next_ == 1) sink.OnSurroundings({{std::make_shared<const SceneMarker>()}, {}, {}});
    sink.OnMoment({1'000'000'000 + 2'000'000 * next_++, 0});
    return State::kMore;
  }
  SourceCounters counters() const override { return {}; }
  std::string description() const override { return "nobody"; }
  bool is_live() const override { return false; }

 private:
  int next_ = 0;
};

struct Collector : SampleSink {
  void OnCharacter(const Character&) override { ++characters; }
  void OnSample(const BodySample& sample) override { samples.push_back(sample); }
  int characters = 0;
  std::vector<BodySample> samples;
};

TEST(PacedSource, KnowsWhenItBeganAndTheTimeOfARound) {
  PacedSource source(std::make_unique<ShortFile>(), [] { return std::make_unique<ShortFile>(); });
  EXPECT_FALSE(source.playback()) << "nothing was delivered";
  Collector collector;
  while (collector.samples.size() < 5) (void)source.Poll(milliseconds(1000), collector);
  const auto playback = source.playback();
  ASSERT_TRUE(playback);
  EXPECT_EQ(playback->start_nanos, collector.samples[0].stamp_nanos);
  EXPECT_EQ(playback->round_nanos, 6'000'000) << "4 ms, and 2 ms to the next round";
  EXPECT_EQ(collector.samples[4].stamp_nanos - playback->start_nanos, 8'000'000);
}

TEST(PacedSource, DeliversEverySampleOnceAndNotTooEarly) {
  PacedSource source(std::make_unique<ShortFile>());
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

TEST(PacedSource, PlaysMomentsWithoutAPersonInALoop) {
  struct : SampleSink {
    void OnCharacter(const Character&) override {}
    void OnSample(const BodySample&) override {}
    void OnSurroundings(const RecordedSurroundings&) override {
      shown_with.push_back(stamps.size());
    }
    void OnMoment(const SourceMoment& moment) override {
      EXPECT_GT(moment.arrival_nanos, 0);
      stamps.push_back(moment.stamp_nanos);
    }
    std::vector<std::int64_t> stamps;
    std::vector<std::size_t> shown_with;
  } sink;
  const auto open = [] { return std::make_unique<FileWithoutPeople>(); };
  PacedSource source(open(), open);
  while (sink.stamps.size() < 6) (void)source.Poll(milliseconds(1000), sink);
  std::vector<std::int64_t> millis;
  for (const std::int64_t stamp : sink.stamps) {
    millis.push_back((stamp - sink.stamps.front()) / kNanosPerMilli);
  }
  EXPECT_THAT(millis, ElementsAre(0, 2, 4, 6, 8, 10));
  EXPECT_THAT(sink.shown_with, ElementsAre(1u, 4u)) << "with the moment that follows";
}

TEST(PacedSource, ReturnsWithoutASampleWhenTheTimeoutIsShorter) {
  PacedSource source(std::make_unique<ShortFile>());
  Collector collector;
  EXPECT_EQ(source.Poll(milliseconds(1000), collector), Source::State::kMore);
  ASSERT_EQ(collector.samples.size(), 1u);
  EXPECT_EQ(source.Poll(milliseconds(0), collector), Source::State::kMore);
}

TEST(PacedSource, ContinuesCounterAndTimeInALoop) {
  PacedSource source(std::make_unique<ShortFile>(), [] { return std::make_unique<ShortFile>(); });
  Collector collector;
  while (collector.samples.size() < 7) {
    ASSERT_NE(source.Poll(milliseconds(1000), collector), Source::State::kEnded);
  }
  EXPECT_EQ(collector.characters, 3);
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_EQ(collector.samples[i].counter, i);
    EXPECT_EQ(collector.samples[i].stamp_nanos - collector.samples[0].stamp_nanos,
              static_cast<std::int64_t>(2'000'000 * i));
    EXPECT_EQ(collector.samples[i].time_code_millis, static_cast<std::int64_t>(2 * i));
  }
}

TEST(PacedSource, MayBeginLaterInTheFirstRound) {
  PacedSource source(
      std::make_unique<ShortFile>(), [] { return std::make_unique<ShortFile>(); }, 1'500'000);
  Collector collector;
  const std::int64_t before = WallNanos();
  while (collector.samples.size() < 6) {
    ASSERT_NE(source.Poll(milliseconds(1000), collector), Source::State::kEnded);
  }
  EXPECT_EQ(collector.characters, 3) << "of each round, though its first sample was left out";
  EXPECT_GE(collector.samples[0].stamp_nanos, before) << "it is played now";
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(collector.samples[i].time_code_millis, static_cast<std::int64_t>(2 + 2 * i));
    EXPECT_EQ(collector.samples[i].stamp_nanos - collector.samples[0].stamp_nanos,
              static_cast<std::int64_t>(2'000'000 * i));
  }
  EXPECT_EQ(source.playback()->start_nanos, collector.samples[0].stamp_nanos - 2'000'000);
  EXPECT_EQ(source.playback()->round_nanos, 6'000'000);
}

TEST(PacedSource, TellsHowFarItHasBeenPassedOver) {
  PacedSource source(std::make_unique<ShortFile>(), nullptr, 3'500'000);
  Collector collector;
  const auto poll = [&] { static_cast<void>(source.Poll(milliseconds(0), collector)); };
  for (int i = 0; source.counters().passed_nanos == 0; ++i) {
    ASSERT_LT(i, 3);
    poll();
  }
  EXPECT_EQ(source.counters().passed_nanos, 2'000'000);
  while (collector.samples.empty()) poll();
  EXPECT_EQ(source.counters().passed_nanos, 0);
}

TEST(PacedSource, ThatEndsBeforeItBeginsSaysWhenItEnds) {
  PacedSource source(std::make_unique<ShortFile>(), nullptr, 4'500'000);
  Collector collector;
  const auto play = [&] {
    while (source.Poll(milliseconds(1000), collector) == Source::State::kMore) {
    }
  };
  try {
    play();
    ADD_FAILURE() << "no error";
  } catch (const SourceError& error) {
    EXPECT_STREQ(
        error.what(),
        "short: ends 0.004 s after its first sample, before 0.005 s; choose an earlier time");
  }
  EXPECT_TRUE(collector.samples.empty());
}

TEST(PacedSource, UpToAMomentDeliversAllBeforeItAtOnceAndNoneAfterIt) {
  const auto source = PacedSource::UpTo(3'000'000, std::make_unique<ShortFile>());
  Collector collector;
  EXPECT_EQ(source->now_nanos(), kStoppedOriginNanos);
  while (source->Poll(milliseconds(1000), collector) == Source::State::kMore) {
    ASSERT_EQ(source->now_nanos(), collector.samples.back().arrival_nanos);
  }
  ASSERT_EQ(collector.samples.size(), 2u) << "of 0, 2 and 4 ms";
  EXPECT_EQ(collector.characters, 1);
  EXPECT_EQ(collector.samples[0].stamp_nanos, 1'000'000'000) << "the recording's own";
  EXPECT_EQ(collector.samples[1].stamp_nanos, 1'002'000'000);
  EXPECT_EQ(collector.samples[0].arrival_nanos, kStoppedOriginNanos) << "in each run";
  EXPECT_EQ(collector.samples[1].arrival_nanos, kStoppedOriginNanos + 2'000'000);
  EXPECT_EQ(source->now_nanos(), kStoppedOriginNanos + 3'000'000) << "and it stands still there";
  EXPECT_EQ(source->Poll(milliseconds(1000), collector), Source::State::kEnded);
  EXPECT_EQ(collector.samples.size(), 2u);
  EXPECT_EQ(source->counters().samples, 2u);
  EXPECT_EQ(source->playback()->start_nanos, 1'000'000'000);
}

TEST(PacedSource, UpToItsLastSampleReachesIt) {
  const auto source = PacedSource::UpTo(4'000'000, std::make_unique<ShortFile>());
  Collector collector;
  while (source->Poll(milliseconds(1000), collector) == Source::State::kMore) {
  }
  EXPECT_EQ(collector.samples.size(), 3u);
}

TEST(PacedSource, UpToAMomentAfterItsEndSaysWhenItEnds) {
  const auto source = PacedSource::UpTo(5'000'000, std::make_unique<ShortFile>());
  Collector collector;
  const auto play = [&] {
    while (source->Poll(milliseconds(1000), collector) == Source::State::kMore) {
    }
  };
  try {
    play();
    FAIL() << "it has no sample there";
  } catch (const SourceError& error) {
    EXPECT_STREQ(error.what(),
                 "short: ends 0.004 s after its first sample, before 0.005 s; choose an earlier "
                 "time");
  }
}

using Steps = std::vector<std::function<void(SampleSink&)>>;

// A recording of two people and a cluster of objects, as it lies in the file.
class Recording : public Source {
 public:
  explicit Recording(Steps steps, std::string error = "")
      : steps_(std::move(steps)), error_(std::move(error)) {}

  State Poll(milliseconds, SampleSink& sink) override {
    if (next_ == steps_.size()) {
      if (!error_.empty()) throw SourceError(error_);
      return State::kEnded;
    }
    steps_[next_++](sink);
    return State::kMore;
  }
  SourceCounters counters() const override {
    SourceCounters counters;
    counters.datagrams = next_;
    counters.samples = 1000;
    counters.types["02"] = next_;
    counters.rejected["id 0"] = 1;
    counters.transport["other_packets"] = 1;
    return counters;
  }
  std::string description() const override { return "recording"; }
  bool is_live() const override { return false; }

 private:
  Steps steps_;
  std::string error_;
  std::size_t next_ = 0;
};

std::function<void(SampleSink&)> Sample(int character, std::uint32_t counter, double millis) {
  return [=](SampleSink& sink) {
    BodySample sample;
    sample.character = character;
    sample.counter = counter;
    sample.stamp_nanos = 1'000'000'000 + static_cast<std::int64_t>(millis * 1e6);
    sink.OnSample(sample);
  };
}

std::function<void(SampleSink&)> Objects(int character, std::uint32_t counter, double millis) {
  return [=](SampleSink& sink) {
    ObjectsSample sample;
    sample.character = character;
    sample.counter = counter;
    sample.stamp_nanos = 1'000'000'000 + static_cast<std::int64_t>(millis * 1e6);
    sink.OnObjects(sample);
  };
}

std::function<void(SampleSink&)> Named(int character, const std::string& name) {
  return [=](SampleSink& sink) {
    Character named;
    named.id = character;
    named.name = name;
    sink.OnCharacter(named);
  };
}

// What came, one word each: "Ann", "0:17" for a sample, "o:3" for objects.
struct Log : SampleSink {
  void OnCharacter(const Character& character) override { words.push_back(character.name); }
  void OnSample(const BodySample& sample) override {
    words.push_back(std::to_string(sample.character) + ":" + std::to_string(sample.counter));
    stamps.push_back(sample.stamp_nanos);
  }
  void OnObjects(const ObjectsSample& sample) override {
    words.push_back("o:" + std::to_string(sample.counter));
    stamps.push_back(sample.stamp_nanos);
  }
  std::vector<std::string> words;
  std::vector<std::int64_t> stamps;
};

void PlayToEnd(PacedSource& source, SampleSink& sink) {
  while (source.Poll(milliseconds(1000), sink) == Source::State::kMore) {
  }
}

TEST(PacedSource, DeliversPeopleAndObjectsInOrderOfTime) {
  PacedSource source(std::make_unique<Recording>(
      Steps{Named(0, "Ann"), Named(1, "Bob"), Sample(0, 10, 0), Sample(0, 11, 4), Sample(1, 70, 1),
            Objects(5, 3, 2), Named(1, "Rob"), Sample(1, 71, 5), Sample(0, 12, 8)}));
  Log log;
  PlayToEnd(source, log);
  EXPECT_THAT(log.words,
              ElementsAre("Ann", "0:10", "Bob", "1:70", "o:3", "0:11", "Rob", "1:71", "0:12"));
  std::vector<std::int64_t> millis;
  for (const std::int64_t stamp : log.stamps) millis.push_back((stamp - log.stamps[0]) / 1'000'000);
  EXPECT_THAT(millis, ElementsAre(0, 1, 2, 4, 5, 8));
}

TEST(PacedSource, ContinuesTheCounterOfEveryPersonInTheNextRound) {
  const auto open = [] {
    return std::make_unique<Recording>(Steps{Sample(0, 6681, 0), Sample(1, 5, 1),
                                             Sample(0, 6682, 2), Sample(1, 6, 3),
                                             Sample(0, 6684, 4), Objects(5, 90, 4.5)});
  };
  PacedSource source(open(), open);
  Log log;
  while (log.words.size() < 12) {
    ASSERT_NE(source.Poll(milliseconds(1000), log), Source::State::kEnded);
  }
  log.words.resize(12);
  EXPECT_THAT(log.words, ElementsAre("0:6681", "1:5", "0:6682", "1:6", "0:6684", "o:90",  //
                                     "0:6685", "1:7", "0:6686", "1:8", "0:6688", "o:91"));
  for (std::size_t i = 1; i < 12; ++i) EXPECT_GT(log.stamps[i], log.stamps[i - 1]) << i;
}

TEST(PacedSource, KeepsTheOrderOfSamplesForAnyTimeStamps) {
  PacedSource source(std::make_unique<Recording>(
      Steps{Sample(0, 1, 5), Sample(0, 2, 3), Sample(0, 3, -3'600'000), Sample(0, 4, 6)}));
  Log log;
  PlayToEnd(source, log);
  EXPECT_THAT(log.words, ElementsAre("0:1", "0:2", "0:3", "0:4"));
  EXPECT_TRUE(std::is_sorted(log.stamps.begin(), log.stamps.end()));
}

TEST(PacedSource, AddsTheCountersOfItsSourceOverAllRounds) {
  const auto open = [] {
    return std::make_unique<Recording>(Steps{Sample(0, 1, 0), Sample(0, 2, 1)});
  };
  PacedSource source(open(), open);
  Log log;
  while (log.words.size() < 7) {
    ASSERT_NE(source.Poll(milliseconds(1000), log), Source::State::kEnded);
  }
  const SourceCounters counters = source.counters();
  EXPECT_EQ(counters.samples, log.words.size()) << "those handed on, not those read ahead";
  EXPECT_GE(counters.datagrams, 7U);
  EXPECT_EQ(counters.types.at("02"), counters.datagrams);
  EXPECT_GE(counters.rejected.at("id 0"), 4U) << "once a round";
  EXPECT_EQ(counters.transport.at("other_packets"), counters.rejected.at("id 0"));
}

TEST(PacedSource, DeliversTheSamplesBeforeAnErrorAndThenTheError) {
  PacedSource source(
      std::make_unique<Recording>(Steps{Sample(0, 1, 0), Sample(0, 2, 3)}, "the file breaks off"));
  Log log;
  EXPECT_THROW(PlayToEnd(source, log), SourceError);
  EXPECT_THAT(log.words, ElementsAre("0:1", "0:2"));
}

TEST(PacedSource, EndsWithAnEmptyFileEvenInALoop) {
  const auto open = [] { return std::make_unique<Recording>(Steps{}); };
  PacedSource source(open(), open);
  Log log;
  EXPECT_EQ(source.Poll(milliseconds(0), log), Source::State::kEnded);
}

}  // namespace
}  // namespace kinescope::app
