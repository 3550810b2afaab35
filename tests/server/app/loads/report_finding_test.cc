#include "server/app/loads/report_finding.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/server/app/loads/trial_scenes.h"

namespace kinescope::app {
namespace {

using testing::AddTo;
using testing::CountedTrial;
using testing::SceneWithRatio;

LoadTrial SteadyTrial(double ratio, const char* why = "") {
  LoadTrial trial(true, 0);
  for (int i = 0; i < 20; ++i) AddTo(trial, SceneWithRatio(0.1 * i, ratio, why));
  trial.Finish();
  return trial;
}

TEST(ReportFinding, NamesTheWorstJointWithLimitShareSamplesAndLongestTime) {
  const Finding finding = FindingOf(CountedTrial(2000), TrialContext());
  EXPECT_EQ(finding.headline,
            "Right knee was above a ratio of 0.60 for 15.0 % of the trial (15 of 100 samples), at "
            "most 1.50 s at a time.");
  EXPECT_EQ(finding.details,
            "Peak compression at L5/S1 was 2000 N (±25 % is 1500 to 2500 N): below 3400 N even at "
            "+25 %. Unknown for 5.0 % of the trial: right knee.");
}

TEST(ReportFinding, NamesTheLowerLimitWhereNoLoadIsHigh) {
  EXPECT_EQ(FindingOf(SteadyTrial(0.4), TrialContext()).headline,
            "No known load was above a ratio of 0.60; L5/S1 was above a ratio of 0.30 for 100 % of "
            "the trial (20 of 20 samples), at most 2.00 s at a time.");
}

TEST(ReportFinding, NamesTheHighestRatioWhereAllLoadsAreLow) {
  LoadTrial trial(true, 0);
  for (int i = 0; i < 20; ++i) {
    SceneState scene = SceneWithRatio(0.1 * i, 0.1);
    if (i == 7) scene.people[0].loads[2].ratio = 0.22;
    AddTo(trial, scene);
  }
  trial.Finish();
  EXPECT_EQ(
      FindingOf(trial, TrialContext()).headline,
      "No known load was above a ratio of 0.30; the highest was 0.22, neck (T1/C7) at 0.70 s.");
}

TEST(ReportFinding, SaysThatNothingIsKnownAndWhy) {
  const Finding finding = FindingOf(SteadyTrial(std::nan(""), "no foot contact"), TrialContext());
  EXPECT_EQ(finding.headline, "No load could be computed at any time.");
  EXPECT_EQ(finding.details, "Reason: no foot contact.");
}

TEST(ReportFinding, ListsRatiosAboveOneWithBothSidesTogether) {
  LoadTrial trial(true, 0);
  for (int i = 0; i < 20; ++i) {
    SceneState scene = SceneWithRatio(0.1 * i, 0.1);
    for (const std::size_t joint : {0, 3, 4, 14}) {
      scene.people[0].loads[joint].ratio = 1.2;
      scene.people[0].loads[joint].band = LoadClass::kHigh;
    }
    AddTo(trial, scene);
  }
  trial.Finish();
  EXPECT_EQ(FindingOf(trial, TrialContext()).details,
            "Above a ratio of 1 (‡): L5/S1, both shoulders, left ankle.");
}

// At every place of the range against both limits.
TEST(ReportFinding, DoesNotCallACompressionAboveALimitThatItsUncertaintyContains) {
  const std::pair<double, const char*> cases[] = {
      {2720, "below 3400 N even at +25 %."},
      {2721, "not above 3400 N, but not beyond doubt; 6400 N was not reached."},
      {3400, "not above 3400 N, but not beyond doubt; 6400 N was not reached."},
      {3401, "above 3400 N, but not beyond doubt; 6400 N was not reached."},
      {4600, "above 3400 N even at −25 %; 6400 N was not reached."},
      {5200, "above 3400 N even at −25 %; not above 6400 N, but not beyond doubt."},
      {6500, "above 3400 N even at −25 %; above 6400 N, but not beyond doubt."},
      {8600, "above 3400 N even at −25 %; above 6400 N even at −25 %."}};
  for (const auto& [newtons, verdict] : cases) {
    EXPECT_THAT(CompressionSentence(newtons), ::testing::EndsWith(std::string("N): ") + verdict));
  }
}

}  // namespace
}  // namespace kinescope::app
