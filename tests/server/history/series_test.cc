#include "server/history/series.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "server/history/history.h"
#include "tests/server/http/test_scene.h"

namespace kinescope::history {
namespace {

using http::testing::MakePersonModel;
using http::testing::MakeScene;
using ::testing::ElementsAre;

constexpr std::int64_t kStepNanos = 1'000'000;  // ns between samples

SceneState SampleAt(std::uint32_t number, int people = 1) {
  static const auto model = MakePersonModel();
  static const SceneState kFirst = MakeScene(1, 0.2, 1, model, 4);
  SceneState state = kFirst;
  state.people.resize(static_cast<std::size_t>(people));
  state.number = number;
  state.made_nanos = number * kStepNanos;
  for (PersonState& person : state.people) {
    person.sample.counter = number;
    person.sample.stamp_nanos = state.made_nanos;
  }
  return state;
}

SeriesQuestion Question(std::vector<std::size_t> keys, std::int64_t from, std::int64_t until,
                        std::size_t columns) {
  return {0, std::move(keys), from * kStepNanos, until * kStepNanos, columns};
}

TEST(Series, HasTheNamesOfAllScoredJointsAndFindsEachKey) {
  EXPECT_EQ(SeriesKeys()[0].name, "l5_s1");
  for (std::size_t i = 0; i < kSeriesKeyCount; ++i) {
    EXPECT_EQ(FindSeriesKey(SeriesKeys()[i].name), i) << SeriesKeys()[i].name;
    EXPECT_GT(SeriesKeys()[i].steps, 0) << SeriesKeys()[i].name;
  }
  EXPECT_FALSE(FindSeriesKey("l5"));
  EXPECT_FALSE(FindSeriesKey(""));
}

TEST(Series, KeepsTheValuesOfASample) {
  Series series;
  SceneState state = SampleAt(5);
  PersonState& person = state.people[0];
  person.com = Eigen::Vector3d(123.45678, -2.5, 1);
  state.rate_hz = 239.98;
  series.Add(state);
  SeriesQuestion all = Question({}, 5, 6, 1);
  for (std::size_t i = 0; i < kSeriesKeyCount; ++i) all.keys.push_back(i);
  const auto answer = series.Ask(all);
  ASSERT_TRUE(answer);
  EXPECT_THAT(answer->samples, ElementsAre(1u));
  const auto value = [&](std::size_t key) {
    return answer->by_key[key][0].max / SeriesKeys()[key].steps;
  };
  for (std::size_t i = 0; i + 1 < kSeriesJoints; ++i) {
    EXPECT_NEAR(value(i), person.loads[i].ratio, 0.5 / 2000) << SeriesKeys()[i].name;
  }
  EXPECT_FALSE(answer->by_key[kSeriesJoints - 1][0].is_known()) << "the left ankle has no load";
  EXPECT_EQ(value(kCompression), 2150);
  EXPECT_NEAR(value(kMargin), 0.083, 1e-9);
  EXPECT_NEAR(value(kComX), 123.4568, 1e-9);
  EXPECT_NEAR(value(kComY), -2.5, 1e-9);
  EXPECT_NEAR(value(kCopX), person.cop->x(), 1e-4);
  EXPECT_EQ(value(kRate), 239.98);
  EXPECT_EQ(value(kLoss), 0);
  int medium = 0, high = 0;
  for (const JointLoad& load : person.loads) {
    medium += load.load_class == LoadClass::kMedium ? 1 : 0;
    high += load.load_class == LoadClass::kHigh ? 1 : 0;
  }
  EXPECT_GT(medium, 0);
  EXPECT_GT(high, 0);
  EXPECT_EQ(value(kMediumJoints), medium + high);
  EXPECT_EQ(value(kHighJoints), high);
  EXPECT_EQ(value(kUnknownJoints), 1);
}

TEST(Series, ShowsAPeakOfOneSampleInEveryNumberOfColumns) {
  Series series;
  for (std::uint32_t i = 0; i < 10'000; ++i) {
    SceneState state = SampleAt(i);
    state.people[0].forces.lumbar->compression = i == 7321 ? 9000 : 1000 + i % 7;
    series.Add(state);
  }
  for (const std::size_t columns : {1u, 3u, 10u, 156u, 157u, 1000u, 4096u}) {
    const auto answer = series.Ask(Question({kCompression}, 0, 10'000, columns));
    std::size_t with_peak = 0, samples = 0;
    for (std::size_t i = 0; i < columns; ++i) {
      const SeriesColumn& column = answer->by_key[0][i];
      samples += answer->samples[i];
      ASSERT_TRUE(column.is_known());
      with_peak += column.max == 9000 ? 1 : 0;
      if (column.max == 9000) EXPECT_EQ(i, 7321 * columns / 10'000) << columns;
    }
    EXPECT_EQ(with_peak, 1u) << columns;
    EXPECT_EQ(samples, 10'000u) << columns;
  }
}

// Whole blocks and single rows must give the same: compares with a sum over all rows.
TEST(Series, AnswersTheSameAsALookAtEverySample) {
  Series series;
  std::vector<std::int32_t> values;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    SceneState state = SampleAt(i);
    values.push_back(1000 + static_cast<std::int32_t>(i * 7919 % 4001));
    state.people[0].forces.lumbar->compression = values.back();
    if (i % 500 > 400) {
      state.people[0].forces.lumbar.reset();
      values.back() = SeriesColumn::kNone;
    }
    series.Add(state);
  }
  for (const auto& [from, until, columns] : {std::array{0, 3000, 10},
                                             {17, 2999, 29},
                                             {100, 101, 1},
                                             {2900, 3400, 50},
                                             {5, 2005, 2000}}) {
    const auto answer =
        series.Ask(Question({kCompression}, from, until, static_cast<std::size_t>(columns)));
    for (int column = 0; column < columns; ++column) {
      std::int32_t min = SeriesColumn::kNone, max = min, last = min;
      std::uint32_t count = 0;
      for (int i = from; i < std::min(until, 3000); ++i) {
        if (static_cast<std::int64_t>(i - from) * columns / (until - from) != column) continue;
        ++count;
        const std::int32_t value = values[static_cast<std::size_t>(i)];
        if (value == SeriesColumn::kNone) continue;
        min = last == SeriesColumn::kNone ? value : std::min(min, value);
        max = last == SeriesColumn::kNone ? value : std::max(max, value);
        last = value;
      }
      const auto at = static_cast<std::size_t>(column);
      ASSERT_EQ(answer->samples[at], count) << from << " " << column;
      ASSERT_EQ(answer->by_key[0][at].min, min) << from << " " << column;
      ASSERT_EQ(answer->by_key[0][at].max, max) << from << " " << column;
      ASSERT_EQ(answer->by_key[0][at].last, last) << from << " " << column;
    }
  }
}

TEST(Series, CountsLostSamplesOfTheLastSecondAtAnyUsualStep) {
  for (const std::uint32_t usual : {1u, 4u}) {
    Series series;
    std::uint32_t counter = 50;
    for (std::uint32_t i = 0; i < 2400; ++i) {
      counter += usual * (i == 900 ? 101 : 1);
      if (i == 1500) counter = 0;  // the sender has started again
      SceneState state = SampleAt(i);
      state.people[0].sample.counter = counter;
      series.Add(state);
    }
    const auto answer = series.Ask(Question({kLoss}, 0, 2400, 24));
    for (std::size_t i = 0; i < 24; ++i) {
      // For a second from sample 900 on, which then has 901 samples, and later 1000.
      const double expected = i < 9 || i >= 19 ? 0 : i == 9 ? 1e4 * 100 / 1001 : 1e4 * 100 / 1100;
      EXPECT_NEAR(answer->by_key[0][i].max, expected, 1) << "step " << usual << ", column " << i;
    }
  }
}

TEST(Series, EndsWithUnknownLoadsWhenTheStreamStopsAndHasAGapAfterIt) {
  Series series;
  for (std::uint32_t i = 0; i < 100; ++i) series.Add(SampleAt(i));
  for (std::uint32_t i = 150; i < 250; ++i) {
    SceneState state = SampleAt(99);
    state.made_nanos = i * kStepNanos;
    state.liveness = Liveness::kStale;
    for (JointLoad& load : state.people[0].loads) {
      load.ratio = std::nan("");
      load.load_class = LoadClass::kUnknown;
    }
    series.Add(state);
  }
  const auto answer = series.Ask(Question({0, kUnknownJoints, kCompression}, 0, 250, 5));
  EXPECT_THAT(answer->samples, ElementsAre(50u, 50u, 0u, 1u, 0u));
  EXPECT_FALSE(answer->by_key[0][3].is_known());
  EXPECT_EQ(answer->by_key[1][3].max, 15);
  EXPECT_FALSE(answer->by_key[2][3].is_known());
}

TEST(Series, KeepsASampleOnceThoughEachStateHasAllPeople) {
  Series series;
  for (std::uint32_t i = 1; i <= 20; ++i) {
    SceneState state = SampleAt(i, 2);
    if (i % 2 == 0) {  // a sample of the second person only
      state.people[0].sample.counter = i - 1;
      state.people[0].sample.stamp_nanos = (i - 1) * kStepNanos;
    }
    series.Add(state);
  }
  SeriesQuestion question = Question({kRate}, 0, 100, 1);
  EXPECT_EQ(series.Ask(question)->samples[0], 10u);
  question.character = 1;
  EXPECT_EQ(series.Ask(question)->samples[0], 20u);
  question.character = 2;
  EXPECT_FALSE(series.Ask(question));
  EXPECT_THAT(series.characters(), ElementsAre(0, 1));
}

TEST(Series, ForgetsWhatIsTooOldOrTooMuch) {
  SeriesLimits limits;
  limits.nanos = 1000 * kStepNanos;
  Series brief(limits);
  for (std::uint32_t i = 0; i < 5000; ++i) brief.Add(SampleAt(i));
  const auto counted = brief.Ask(Question({kRate}, 0, 5000, 1))->samples[0];
  EXPECT_GE(counted, 1000u);
  EXPECT_LE(counted, 1064u);
  // One who left is forgotten although the other ones go on.
  brief.Add(SampleAt(5001, 2));
  for (std::uint32_t i = 5002; i < 6100; ++i) brief.Add(SampleAt(i));
  EXPECT_THAT(brief.characters(), ElementsAre(0));

  limits = SeriesLimits();
  limits.bytes = brief.bytes() / 2;
  Series small(limits);
  for (std::uint32_t i = 0; i < 5000; ++i) small.Add(SampleAt(i, 3));
  EXPECT_LE(small.bytes(), limits.bytes);
  EXPECT_GT(small.bytes(), limits.bytes / 2);
  const SeriesQuestion newest = Question({kRate}, 4990, 5000, 1);
  EXPECT_EQ(small.Ask(newest)->samples[0], 10u);
}

TEST(Series, TakesAbout40MegabytesForFourPeopleInTenMinutes) {
  Series series;
  for (std::uint32_t i = 0; i < 6400; ++i) series.Add(SampleAt(i, 1));
  const double per_sample = static_cast<double>(series.bytes()) / 6400;
  EXPECT_LT(per_sample * 4 * 240 * 600, 42e6) << per_sample << " bytes a sample";
}

TEST(Series, ServesReadersWhileSamplesCome) {
  History history;
  history.Add(std::make_shared<const SceneState>(SampleAt(1)));
  std::thread reader([&] {
    const SeriesQuestion question = Question({0, kComY}, 0, 3000, 7);
    for (std::uint32_t seen = 0; seen < 2000;) {
      const auto answer = history.series().Ask(question);
      std::uint32_t now = 0;
      for (const std::uint32_t count : answer->samples) now += count;
      ASSERT_GE(now, seen);
      seen = now;
    }
  });
  for (std::uint32_t i = 2; i <= 2000; ++i) {
    history.Add(std::make_shared<const SceneState>(SampleAt(i)));
  }
  reader.join();
}

}  // namespace
}  // namespace kinescope::history
