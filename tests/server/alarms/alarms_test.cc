#include "server/alarms/alarms.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "server/alarms/alarm_json.h"
#include "server/alarms/rule_file.h"

namespace kinescope::alarms {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr int kBack = 0, kShoulder = 1;  // places in kScoredJoints

// A stream of states, 0.1 s apart, whose people have the loads that a test gives them.
class AlarmsTest : public ::testing::Test {
 protected:
  void Start(const std::string& rules, bool is_live = true) {
    alarms_.emplace(ParseRules("test", rules), is_live, [this](const Alarm& alarm, Change change) {
      events_.push_back(alarm.rule.name + " of " +
                        (alarm.person.empty() ? "stream" : alarm.person) + ": " + Name(change));
    });
  }

  static PersonState MakePerson(int character, const std::vector<double>& ratios) {
    PersonState person;
    person.character = character;
    person.name = character == 0 ? "Anna" : "Ben";
    for (std::size_t i = 0; i < ratios.size(); ++i) {
      JointLoad load;
      load.joint = urdf::kScoredJoints[i];
      load.ratio = ratios[i];
      person.loads.push_back(load);
    }
    return person;
  }

  void Feed(std::vector<PersonState> people, int count = 1, Liveness liveness = Liveness::kLive) {
    for (int i = 0; i < count; ++i) {
      SceneState state;
      state.number = ++number_;
      state.made_nanos = now_nanos_ += 100'000'000;
      state.stamp_nanos = state.made_nanos + 7;
      state.liveness = liveness;
      state.people = people;
      state.class_limits = class_limits_;
      for (PersonState& person : state.people) person.sample.stamp_nanos = state.stamp_nanos;
      alarms_->OnState(state);
    }
  }
  void Pass(double secs, std::optional<double> loss = std::nullopt) {
    now_nanos_ += static_cast<std::int64_t>(secs * 1e9);
    alarms_->OnTime(now_nanos_, loss);
  }
  std::vector<std::string> Shown() const {
    std::vector<std::string> texts;
    for (const Alarm& alarm : alarms_->shown()) texts.push_back(Describe(alarm));
    return texts;
  }

  std::optional<Alarms> alarms_;
  std::vector<std::string> events_;
  std::array<double, 2> class_limits_ = kDefaultClassLimits;
  std::uint64_t number_ = 0;
  std::int64_t now_nanos_ = 5'000'000'000, ben_nanos_ = 0;
};

constexpr char kRatioRule[] =
    "rules:\n  - {name: load, value: ratio, above: 0.6, for: 0.5, over_after: 0.5}\n";
constexpr char kLatchedRule[] =
    "rules:\n  - {name: load, value: ratio, above: 0.6, over_after: 0, priority: high}\n";

TEST_F(AlarmsTest, BeginsIsShownAndIsOver) {
  Start(kRatioRule);
  Feed({MakePerson(0, {0.2, 0.3})}, 10);
  EXPECT_THAT(Shown(), IsEmpty());
  Feed({MakePerson(0, {0.2, 0.7})}, 6);
  EXPECT_THAT(events_, ElementsAre("load of Anna: began"));
  EXPECT_THAT(
      Shown(),
      ElementsAre("Anna: " + std::string(urdf::kJoints[urdf::At(urdf::kScoredJoints[1])].label) +
                  " load 70 %, more than 60 %"));
  EXPECT_EQ(alarms_->shown().at(0).began.state, 11u);
  Feed({MakePerson(0, {0.2, 0.3})}, 6);
  EXPECT_THAT(Shown(), IsEmpty());
  EXPECT_THAT(events_, ElementsAre("load of Anna: began", "load of Anna: over"));
  EXPECT_EQ(alarms_->log().size(), 1u);
}

TEST_F(AlarmsTest, EachPersonHasAlarmsOfTheirOwn) {
  Start(kRatioRule);
  Feed({MakePerson(0, {0.7}), MakePerson(1, {0.2})}, 6);
  EXPECT_THAT(events_, ElementsAre("load of Anna: began"));
  Feed({MakePerson(0, {0.7}), MakePerson(1, {0.9})}, 6);
  EXPECT_THAT(events_, ElementsAre("load of Anna: began", "load of Ben: began"));
  EXPECT_EQ(alarms_->shown().at(0).person, "Ben") << "newest first";
}

TEST_F(AlarmsTest, OfAPersonWhoSendsNothingTheLastValueDoesNotGoOn) {
  Start("rules:\n  - {name: load, value: ratio, above: 0.6, for: 1}\n");
  const auto feed = [this](double seconds, bool ben_sends) {
    for (double at = 0; at < seconds; at += 0.1) {
      SceneState state;
      state.number = ++number_;
      state.made_nanos = state.stamp_nanos = now_nanos_ += 100'000'000;
      state.liveness = Liveness::kLive;
      state.people = {MakePerson(0, {0.2}), MakePerson(1, {0.9})};
      if (ben_sends) ben_nanos_ = state.stamp_nanos;
      state.people[0].sample.stamp_nanos = state.stamp_nanos;
      state.people[1].sample.stamp_nanos = ben_nanos_;
      alarms_->OnState(state);
    }
  };
  feed(0.5, true);
  feed(5, false);
  EXPECT_THAT(events_, ElementsAre("lost of Ben: began")) << "Ben's load of then is not now";
  feed(2, true);
  EXPECT_EQ(events_.back(), "load of Ben: began");
}

TEST_F(AlarmsTest, UnknownNeitherBeginsNorEnds) {
  Start(kRatioRule);
  Feed({MakePerson(0, {kUnknown, kUnknown})}, 20);
  EXPECT_THAT(events_, IsEmpty());
  Feed({MakePerson(0, {0.9, 0.2})}, 6);
  Feed({MakePerson(0, {kUnknown, 0.2})}, 20);
  EXPECT_THAT(events_, ElementsAre("load of Anna: began"))
      << "its joint is unknown, others are low";
  Feed({MakePerson(0, {0.2, 0.2})}, 6);
  EXPECT_THAT(events_, ElementsAre("load of Anna: began", "load of Anna: over"));
}

TEST_F(AlarmsTest, ALatchedAlarmStaysUntilItIsAcknowledged) {
  Start(kLatchedRule);
  Feed({MakePerson(0, {0.9})});
  Feed({MakePerson(0, {0.1})});
  ASSERT_EQ(alarms_->shown().size(), 1u);
  EXPECT_FALSE(alarms_->shown()[0].is_on());
  const auto answer = alarms_->Acknowledge(1, "operator");
  ASSERT_TRUE(answer) << answer.error();
  EXPECT_EQ(answer->acknowledged->role, "operator");
  EXPECT_THAT(Shown(), IsEmpty());
  EXPECT_THAT(events_, ElementsAre("load of Anna: began", "load of Anna: over",
                                   "load of Anna: acknowledged"));
}

TEST_F(AlarmsTest, OneThatIsOnIsShownAfterBeingAcknowledged) {
  Start(kLatchedRule);
  Feed({MakePerson(0, {0.9})});
  ASSERT_TRUE(alarms_->Acknowledge(1, "operator"));
  ASSERT_EQ(alarms_->shown().size(), 1u);
  Feed({MakePerson(0, {0.1})});
  EXPECT_THAT(Shown(), IsEmpty());
  Feed({MakePerson(0, {0.9})});
  ASSERT_EQ(alarms_->shown().size(), 1u);
  EXPECT_EQ(alarms_->shown()[0].id, 2u) << "a new alarm, not acknowledged";
}

TEST_F(AlarmsTest, OneThatBeginsAgainBeforeItIsAcknowledgedIsTheSame) {
  Start(kLatchedRule);
  for (int i = 0; i < 3; ++i) {
    Feed({MakePerson(0, {0.7 + 0.1 * i})});
    Feed({MakePerson(0, {0.1})});
  }
  EXPECT_EQ(alarms_->log().size(), 1u);
  EXPECT_EQ(alarms_->log()[0].times, 3);
  EXPECT_THAT(Shown()[0], HasSubstr("90 %")) << "the worst of all";
}

TEST_F(AlarmsTest, WhatCannotBeAcknowledgedIsRefused) {
  Start(kLatchedRule);
  EXPECT_EQ(alarms_->Acknowledge(7, "operator").error(), "alarm 7 is not known");
  Feed({MakePerson(0, {0.9})});
  ASSERT_TRUE(alarms_->Acknowledge(1, "operator"));
  EXPECT_EQ(alarms_->Acknowledge(1, "operator").error(), "alarm 1 has been acknowledged before");
}

TEST_F(AlarmsTest, ALostStreamRaisesWithoutARuleAndEndsByItself) {
  Start("rules: []");
  Pass(10);
  EXPECT_THAT(events_, IsEmpty()) << "no stream yet";
  Feed({MakePerson(0, {0.1})});
  Pass(1.9);
  EXPECT_THAT(events_, IsEmpty());
  Pass(0.2);
  EXPECT_THAT(events_, ElementsAre("lost of stream: began"));
  Pass(1.2);
  EXPECT_THAT(Shown(), ElementsAre("stream: lost for 3.3 s"));
  Feed({MakePerson(0, {0.1})});
  EXPECT_THAT(Shown(), IsEmpty());
  EXPECT_EQ(alarms_->log().size(), 1u) << "it stays in the log";
}

TEST_F(AlarmsTest, AStaleStreamIsNoSample) {
  Start("rules:\n  - {name: stale, value: stale, above: 0.5}\nlost_after: 3");
  Feed({MakePerson(0, {0.1})});
  Feed({MakePerson(0, {kUnknown})}, 6, Liveness::kStale);
  EXPECT_THAT(events_, ElementsAre("stale of stream: began"));
}

TEST_F(AlarmsTest, ALostPersonRaisesAndTheirLoadsEnd) {
  Start(kRatioRule);
  Feed({MakePerson(0, {0.9}), MakePerson(1, {0.1})}, 6);
  Feed({MakePerson(1, {0.1})}, 21);
  EXPECT_THAT(events_,
              ElementsAre("load of Anna: began", "load of Anna: over", "lost of Anna: began"));
  Feed({MakePerson(0, {0.1}), MakePerson(1, {0.1})});
  EXPECT_THAT(Shown(), IsEmpty());
}

TEST_F(AlarmsTest, APersonWhoseLossIsAcknowledgedIsNotExpectedAgain) {
  Start("rules: []");
  Feed({MakePerson(0, {0.1}), MakePerson(1, {0.1})});
  Feed({MakePerson(1, {0.1})}, 25);
  ASSERT_EQ(alarms_->shown().size(), 1u);
  ASSERT_TRUE(alarms_->Acknowledge(alarms_->shown()[0].id, "operator"));
  Feed({MakePerson(1, {0.1})}, 25);
  EXPECT_THAT(Shown(), IsEmpty());
}

TEST_F(AlarmsTest, WhileTheStreamIsLostNoPersonIs) {
  Start("rules: []");
  Feed({MakePerson(0, {0.1}), MakePerson(1, {0.1})});
  Pass(30);
  EXPECT_THAT(events_, ElementsAre("lost of stream: began"));
}

TEST_F(AlarmsTest, ARecordingIsNeverLost) {
  Start("rules:\n  - {name: stale, value: stale, above: 0.5}", /*is_live=*/false);
  Feed({MakePerson(0, {0.1})});
  Pass(30);
  EXPECT_THAT(events_, IsEmpty());
}

TEST_F(AlarmsTest, LossesOfTheStreamRaise) {
  Start("rules:\n  - {name: losing, value: loss, above: 0.02, for: 1}");
  Feed({MakePerson(0, {0.1})});
  for (int i = 0; i < 3; ++i) Pass(0.5, 0.054);
  EXPECT_THAT(Shown(),
              ElementsAre("stream: samples lost or incomplete in 10 s 5.4 %, more than 2.0 %"));
}

TEST_F(AlarmsTest, ExposureRaisesAfterAMinute) {
  Start("rules:\n  - {name: dose, value: exposure, of: medium, above: 0.3}");
  PersonState person = MakePerson(0, {0.1});
  person.loads[kBack].band_secs = {100, 30, 10, 10};
  Feed({person}, 3);
  EXPECT_THAT(events_, IsEmpty()) << "50 s are known";
  person.loads[kBack].band_secs = {100, 40, 15, 15};
  Feed({person}, 3);
  ASSERT_EQ(events_.size(), 1u);
  EXPECT_THAT(Shown()[0], HasSubstr("time in class medium or high 43 %, more than 30 %"));
}

TEST_F(AlarmsTest, ClassesAreThoseThatPeopleSee) {
  Start("rules:\n  - {name: red, value: class}");
  PersonState person = MakePerson(0, {2.0, 0.1});
  person.loads[kBack].load_class = LoadClass::kMedium;
  person.loads[kShoulder].load_class = LoadClass::kLow;
  Feed({person}, 3);
  EXPECT_THAT(events_, IsEmpty());
  person.loads[kShoulder].load_class = LoadClass::kHigh;
  Feed({person}, 3);
  EXPECT_THAT(events_, ElementsAre("red of Anna: began"));
  EXPECT_EQ(alarms_->shown()[0].joint, urdf::kScoredJoints[1]);
}

TEST_F(AlarmsTest, ALimitThatIsAClassFollowsTheLimitsOfTheClasses) {
  Start("rules:\n  - {name: red, value: ratio, above: high, over_after: 0}");
  Feed({MakePerson(0, {0.59})});
  EXPECT_THAT(events_, IsEmpty());
  Feed({MakePerson(0, {0.61})});
  EXPECT_THAT(events_, ElementsAre("red of Anna: began"));
  class_limits_ = {0.4, 0.8};
  Feed({MakePerson(0, {0.79})});
  EXPECT_EQ(events_.size(), 1u) << "within the band of 5 %";
  Feed({MakePerson(0, {0.75})});
  EXPECT_EQ(events_.back(), "red of Anna: over");
  EXPECT_EQ(alarms_->rules()[0].limit, 0.8);
}

TEST_F(AlarmsTest, TheLogIsBounded) {
  Start("rules:\n  - {name: load, value: ratio, above: 0.6, over_after: 0}");
  for (std::size_t i = 0; i < Alarms::kMostKept + 50; ++i) {
    Feed({MakePerson(0, {0.9})});
    Feed({MakePerson(0, {0.1})});
  }
  EXPECT_EQ(alarms_->log().size(), Alarms::kMostKept);
  EXPECT_EQ(alarms_->log()[0].id, Alarms::kMostKept + 50);
}

TEST_F(AlarmsTest, TheMessageChangesOnlyWithWhatItSays) {
  Start(kLatchedRule);
  Feed({MakePerson(0, {0.9})});
  const std::string text = ShownJson(*alarms_);
  Feed({MakePerson(0, {0.9000001})});
  EXPECT_EQ(ShownJson(*alarms_), text);
  EXPECT_THAT(text, HasSubstr(R"("text":"Anna: )"));
  EXPECT_THAT(LogJson(*alarms_), HasSubstr(R"("name":"lost")"));
}

TEST_F(AlarmsTest, AMarginIsNotKnownWhileThePersonProbablySitsOrLeans) {
  Start("rules:\n  - {name: unsteady, value: margin, below: -0.1, for: 0.2}\n");
  PersonState person = MakePerson(0, {});
  person.forces.margin_of_stability = -0.3;
  person.forces.external_contact_suspected = true;
  Feed({person}, 5);
  EXPECT_THAT(events_, IsEmpty());
  person.forces.external_contact_suspected = false;
  Feed({person}, 5);
  EXPECT_THAT(events_, ElementsAre("unsteady of Anna: began"));
}

}  // namespace
}  // namespace kinescope::alarms
