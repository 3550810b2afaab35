#include "server/app/loads/trial_marks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/app/loads/load_plots.h"
#include "server/app/loads/load_summary.h"
#include "server/app/loads/report_figures.h"
#include "server/table/load_rows.h"
#include "tests/server/app/loads/trial_scenes.h"

namespace kinescope::app {
namespace {

using testing::CountedTrial;
using testing::SceneWithRatio;

TrialMark MarkAt(double secs) {
  TrialMark mark;
  mark.from_secs = mark.to_secs = secs;
  return mark;
}

TEST(TrialMarks, HaveTheHighestLoadsAroundThem) {
  const LoadTrial trial = CountedTrial();
  const MarkLoads around = LoadsAround(MarkAt(5.5), trial);  // 3 s before and after
  EXPECT_DOUBLE_EQ(around.from_secs, 2.5);
  EXPECT_DOUBLE_EQ(around.to_secs, 8.5);
  ASSERT_TRUE(around.highest);
  EXPECT_EQ(ScoredName(around.highest->joint), "right_knee");
  EXPECT_FLOAT_EQ(static_cast<float>(around.highest->ratio), 0.9F);
  EXPECT_EQ(around.highest->band, LoadClass::kHigh);
  EXPECT_NEAR(around.highest->at_secs, 8.0, 1e-6);
  EXPECT_DOUBLE_EQ(around.compression_N.value(), 2000);
  EXPECT_EQ(LoadsText(around), "0.90 Right knee, 2000 N");

  TrialMark span = MarkAt(1);
  span.to_secs = 2;
  span.is_span = true;
  const MarkLoads within = LoadsAround(span, trial);
  EXPECT_FLOAT_EQ(static_cast<float>(within.highest->ratio), 0.2F);
  EXPECT_DOUBLE_EQ(within.compression_N.value(), 1000);
  EXPECT_EQ(TimesText(span), "1.00 to 2.00 s");
}

TEST(TrialMarks, SayThatNoLoadIsKnown) {
  EXPECT_EQ(LoadsText(LoadsAround(MarkAt(50), CountedTrial())), "no load known");
}

TEST(TrialMarks, SayWhatWasChangedWhileLoadsWereComputedAsAtTheBeginning) {
  TrialContext context;
  const auto changes_of = [&](const std::string& name) {
    return ChangesText(context.marks, name, {"Demo", "Ben"});
  };
  EXPECT_EQ(changes_of("Demo"), "");
  for (const char* text :
       {"camera of the server picture: front → left", "grasp",
        "hand load of Demo: unknown → right 7 kg", "recording: off → a.pcapng"}) {
    context.marks.push_back(MarkAt(1.5 * static_cast<double>(context.marks.size())));
    context.marks.back().text = text;
    context.marks.back().is_change = context.marks.back().text != "grasp";
  }
  const std::string expected =
      "Computed with what held at the beginning, although this was changed: hand load of Demo: "
      "unknown → right 7 kg at 3.00 s.";
  EXPECT_EQ(changes_of("Demo"), expected);
  EXPECT_EQ(changes_of("Ben"), "") << "of another";
  EXPECT_EQ(ChangesText(context.marks, "p1", {"p1"}), expected) << "of a name that it had";
  EXPECT_EQ(NotesOf(CountedTrial(), context).front(), expected);
  context.marks.assign(9, context.marks[2]);
  EXPECT_THAT(changes_of("Demo"), ::testing::EndsWith(" and 5 more."));
}

// A key that was held down all day.
TEST(TrialMarks, AreShortInTextsHoweverManyThereAre) {
  const LoadTrial trial = CountedTrial();
  TrialContext context;
  context.marks.assign(10'000, MarkAt(5));
  for (TrialMark& mark : context.marks) mark.text = "slip";
  const render::Plot plot = JointPlot(trial, context, 0);
  EXPECT_LT(plot.height, 1000);
  EXPECT_EQ(plot.texts.back().text, "and 9981 more");
  EXPECT_LT(TimeFigure(trial, context, 55).size(), 100'000U);
  const TrialSummary summary = SummaryOf(trial, context);
  EXPECT_EQ(summary.marks.size(), 10'000U);
  EXPECT_THAT(SummaryText(summary), ::testing::HasSubstr("and 9960 more, in --json"));
}

TEST(TrialMarks, HaveTimesOfTheRecording) {
  marks::Mark mark;
  mark.id = 1;
  mark.text = "slip";
  mark.button = 3;
  mark.role = "operator";
  mark.at.time_code_millis = 43'202'500;
  SceneState first = SceneWithRatio(0, 0.1), last = SceneWithRatio(9, 0.1);
  first.time_code_millis = 43'200'000;
  last.time_code_millis = 43'209'000;
  const auto found = MarksOf({{mark}, marks::TrackClock::kTimeCode}, first, last);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_DOUBLE_EQ(found[0].from_secs, 2.5);
  EXPECT_FALSE(found[0].is_span);
  EXPECT_EQ(found[0].button, 3);
  EXPECT_EQ(TimesText(found[0]), "2.50 s");
}

}  // namespace
}  // namespace kinescope::app
