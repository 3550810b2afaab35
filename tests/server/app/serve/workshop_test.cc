#include "server/app/serve/workshop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <stdexcept>
#include <string>
#include <thread>

#include "server/app/serve/report_maker.h"
#include "tests/deadline.h"

namespace kinescope::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;
using State = Workshop::State;

Workshop::Job JobOf(const Workshop& workshop, std::uint64_t id) {
  for (const Workshop::Job& job : workshop.jobs()) {
    if (job.id == id) return job;
  }
  return {};
}

void AwaitEnd(const Workshop& workshop, std::uint64_t jobs) {
  testing::WithDeadline([&] {
    while (workshop.ended() < jobs) std::this_thread::yield();
  });
}

TEST(Workshop, MakesOneFileAfterTheOtherAndTellsHowFarItIs) {
  Workshop workshop;
  std::promise<void> began, may_end;
  const auto first = workshop.Add("clip", "a.mp4", [&](Workshop::Progress& progress) {
    progress.Set(0.25);
    began.set_value();
    may_end.get_future().wait();
  });
  const auto second = workshop.Add("report", "b.html", [](Workshop::Progress&) {});
  ASSERT_TRUE(first && second);
  began.get_future().wait();
  EXPECT_EQ(JobOf(workshop, *first).state, State::kMaking);
  EXPECT_EQ(JobOf(workshop, *first).progress, 0.25);
  EXPECT_EQ(JobOf(workshop, *second).state, State::kWaiting);
  EXPECT_THAT(workshop.Add("clip", "a.mp4", [](Workshop::Progress&) {}).error(),
              HasSubstr("a.mp4 is being made already"));
  may_end.set_value();
  AwaitEnd(workshop, 2);
  EXPECT_EQ(JobOf(workshop, *first).state, State::kDone);
  EXPECT_EQ(JobOf(workshop, *second).state, State::kDone);
}

TEST(Workshop, TellsWhyAJobFailedAndGoesOn) {
  Workshop workshop;
  const auto failed = workshop.Add("clip", "a.mp4", [](Workshop::Progress&) {
    throw std::runtime_error("a.mp4: No space left on device");
  });
  const auto done = workshop.Add("clip", "b.mp4", [](Workshop::Progress&) {});
  AwaitEnd(workshop, 2);
  EXPECT_EQ(JobOf(workshop, *failed).state, State::kFailed);
  EXPECT_EQ(JobOf(workshop, *failed).problem, "a.mp4: No space left on device");
  EXPECT_EQ(JobOf(workshop, *done).state, State::kDone);
}

TEST(Workshop, CancelsJobsThatWaitAndTheOneThatIsBeingMade) {
  Workshop workshop;
  std::promise<void> began;
  const auto first = workshop.Add("clip", "a.mp4", [&](Workshop::Progress& progress) {
    began.set_value();
    while (progress.is_wanted()) std::this_thread::yield();
  });
  bool was_made = false;
  const auto second = workshop.Add("clip", "b.mp4", [&](Workshop::Progress&) { was_made = true; });
  began.get_future().wait();
  EXPECT_TRUE(workshop.Cancel(*second));
  EXPECT_TRUE(workshop.Cancel(*first));
  AwaitEnd(workshop, 1);
  EXPECT_EQ(JobOf(workshop, *first).state, State::kCancelled);
  EXPECT_EQ(JobOf(workshop, *second).state, State::kCancelled);
  EXPECT_FALSE(was_made);
  EXPECT_FALSE(workshop.Cancel(*first));
  EXPECT_FALSE(workshop.Cancel(4711));
}

TEST(Workshop, LimitsHowManyJobsWaitAndHowManyItRemembers) {
  std::promise<void> may_end;
  Workshop workshop;
  const std::shared_future<void> gate = may_end.get_future().share();
  const auto work = [gate](Workshop::Progress&) { gate.wait(); };
  for (std::size_t i = 0; i < Workshop::kMostWaiting; ++i) {
    ASSERT_TRUE(workshop.Add("clip", std::to_string(i) + ".mp4", work));
  }
  EXPECT_THAT(workshop.Add("clip", "more.mp4", work).error(),
              HasSubstr("100 clips and reports wait"));
  may_end.set_value();
  AwaitEnd(workshop, Workshop::kMostWaiting);
  EXPECT_EQ(workshop.jobs().size(), Workshop::kMostEnded);
}

TEST(ReportOptions, AreThoseThatDifferFromTheirDefaults) {
  PersonOptions person;
  LoadOptions loads;
  EXPECT_THAT(LoadsOptionsOf(person, loads), ElementsAre());
  person.mass.Parse("80");
  loads.class_limits.Parse("0.2,0.5");
  OptionTexts options = LoadsOptionsOf(person, loads);
  EXPECT_THAT(options, ElementsAre(Pair("mass", "80"), Pair("class_limits", "0.2,0.5")));
  SetOption(options, "mass", "82.5");
  SetOption(options, "hand_load", "right:5");
  EXPECT_EQ(OptionsFromLines(ToLines(options)), options);
}

TEST(ReportOptions, OfAFileNameNothingButThePersonAndTheLoads) {
  EXPECT_THAT(OptionsFromLines("mass=80\nreport=/etc/x\ncsv=/etc/y\n\nnonsense\nsex=female\n"),
              ElementsAre(Pair("mass", "80"), Pair("sex", "female")));
}

}  // namespace
}  // namespace kinescope::app
