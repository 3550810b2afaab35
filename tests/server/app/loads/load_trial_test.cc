#include "server/app/loads/load_trial.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/system/clocks.h"
#include "server/app/loads/load_summary.h"
#include "server/table/load_rows.h"
#include "tests/server/app/loads/trial_scenes.h"

namespace kinescope::app {
namespace {

using testing::AddTo;
using testing::SceneWithRatio;

TEST(LoadTrial, FindsTheTimesOfTheHighestLoadsApartFromEachOther) {
  LoadTrial trial(false, 0);
  for (int i = 0; i <= 1000; ++i) {  // 10 s with peaks at 2, 5 and 8 s
    const double secs = 0.01 * i;
    const double ratio = 0.1 + 0.5 * std::exp(-10 * std::pow(secs - 2, 2)) +
                         0.7 * std::exp(-10 * std::pow(secs - 5, 2)) +
                         0.3 * std::exp(-10 * std::pow(secs - 8, 2));
    AddTo(trial, SceneWithRatio(secs, ratio));
  }
  const std::vector<WorstMoment> worst = trial.Worst(3);
  ASSERT_EQ(worst.size(), 3U);
  EXPECT_NEAR(trial.SecsOf(worst[0].scene->stamp_nanos), 5, 0.02);
  EXPECT_NEAR(trial.SecsOf(worst[1].scene->stamp_nanos), 2, 0.02);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_GE(std::abs(worst[i].scene->stamp_nanos - worst[k].scene->stamp_nanos),
                1000 * kNanosPerMilli);
    }
  }
}

// Two peaks 0.8 s apart are one posture in a long trial, two in a short one.
TEST(LoadTrial, KeepsWorstTimesOneSecondApartWhereTheTrialIsLongEnough) {
  for (const double secs : {1.6, 10.0}) {
    LoadTrial trial(false, 0);
    for (int i = 0; i <= 100 * secs; ++i) {
      AddTo(trial, SceneWithRatio(0.01 * i, i == 40 ? 0.9 : i == 120 ? 0.8 : 0.1));
    }
    trial.Finish();
    const double second = trial.SecsOf(trial.Worst(2).at(1).scene->stamp_nanos);
    EXPECT_EQ(std::abs(second - 1.2) < 1e-9, secs < 3) << second << " s of " << secs;
  }
}

// Compression at 7 s; the right knee at 2 s, and less at 4 s; the left knee at 9 s.
TEST(LoadTrial, ShowsCompressionThenTheHighestRatioThenThatOfAnotherJoint) {
  LoadTrial trial(false, 0);
  for (int i = 0; i < 100; ++i) {
    SceneState scene = SceneWithRatio(0.1 * i, 0.1);
    PersonState& person = scene.people[0];
    person.forces.lumbar = LumbarLoad{i == 70 ? 3000.0 : 500.0, 0};
    person.loads[11].ratio = i == 20 ? 0.9 : i == 40 ? 0.8 : 0.1;
    person.loads[12].ratio = i == 90 ? 0.5 : 0.1;
    AddTo(trial, scene);
  }
  trial.Finish();
  const std::vector<WorstMoment> postures = trial.WorstPostures(3);
  ASSERT_EQ(postures.size(), 3U);
  EXPECT_TRUE(postures[0].is_of_compression);
  EXPECT_FALSE(postures[1].is_of_compression);
  const double secs[] = {7, 2, 9};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(trial.SecsOf(postures[i].scene->stamp_nanos), secs[i], 1e-9);
  }
  EXPECT_EQ(postures[1].joint, 11U);
  EXPECT_EQ(postures[2].joint, 12U);
}

// An hour, in which only so many scenes may be kept.
TEST(LoadTrial, KeepsThePeakOfALongTrial) {
  LoadTrial trial(false, 0);
  for (int i = 0; i < 36000; ++i) {
    AddTo(trial, SceneWithRatio(0.1 * i, i == 20000 ? 0.9 : 0.1 + 1e-6 * i));
  }
  const std::vector<WorstMoment> worst = trial.Worst(3);
  ASSERT_EQ(worst.size(), 3U);
  EXPECT_NEAR(trial.SecsOf(worst[0].scene->stamp_nanos), 2000, 1e-6);
}

TEST(LoadTrial, FindsNoTimeOfTheHighestLoadIfAllLoadsAreUnknown) {
  LoadTrial trial(false, 0);
  for (int i = 0; i < 100; ++i) {
    AddTo(trial, SceneWithRatio(0.01 * i, std::nan(""), "no foot contact"));
  }
  trial.Finish();
  EXPECT_TRUE(trial.Worst(3).empty());
  EXPECT_FALSE(trial.knows_anything());
  ASSERT_EQ(trial.why_unknown(0).size(), 1U);
  EXPECT_NEAR(trial.why_unknown(0).at("no foot contact"), 1, 1e-9);
  const std::vector<std::string> notes = NotesOf(trial, TrialContext());
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
    return note.find("100 % of the time (1.00 s)") != std::string::npos &&
           note.find("no foot contact") != std::string::npos;
  }));
}

TEST(LoadTrial, KeepsCurvesOnlyIfPlotsAreRequested) {
  LoadTrial without(false, 0), with(true, 0);
  for (int i = 0; i < 10; ++i) {
    AddTo(without, SceneWithRatio(0.01 * i, 0.2));
    AddTo(with, SceneWithRatio(0.01 * i, 0.2));
  }
  EXPECT_TRUE(without.curves().empty());
  ASSERT_EQ(with.curves().size(), 10U);
  EXPECT_FLOAT_EQ(with.curves()[3].joints[4].ratio, 0.2F);
}

TEST(LoadRows, WriteUtcTimesBeforeAndAfterTheEpoch) {
  EXPECT_EQ(IsoTime(0), "1970-01-01T00:00:00.000000Z");
  EXPECT_EQ(IsoTime(1'577'836'800'008'333'333), "2020-01-01T00:00:00.008333Z");
  EXPECT_EQ(IsoTime(-1), "1969-12-31T23:59:59.999999Z");
}

}  // namespace
}  // namespace kinescope::app
