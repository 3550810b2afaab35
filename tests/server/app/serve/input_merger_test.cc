#include "server/app/serve/input_merger.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "core/system/clocks.h"
#include "server/app/serve/change_mailbox.h"
#include "server/loads/joint_score.h"
#include "server/subject/subject.h"

namespace kinescope::app {
namespace {

using urdf::kLeft;
using urdf::kRight;

HandLoad HeldInRightHand(double mass_kg) {
  HandLoad load;
  load.is_known = true;
  load.mass_kg[kRight] = mass_kg;
  return load;
}

BodySample TPose(double secs, int character = 0) {
  BodySample sample = subject::MakeMotion("t_pose")->At(secs);
  sample.character = character;
  sample.stamp_nanos = std::llround(secs * 1e9) + 1;
  sample.arrival_nanos = sample.stamp_nanos;
  return sample;
}

const JointLoad& LoadOf(const PersonState& person, int joint) {
  for (const JointLoad& load : person.loads) {
    if (load.joint == joint) return load;
  }
  throw std::out_of_range("no such joint");
}

class Wired {
 public:
  explicit Wired(ros_bridge::RosBridge* ros = nullptr)
      : builder({}, "test", 0,
                [this](std::shared_ptr<const SceneState> state) { last = std::move(state); }),
        sink(
            builder, overload, hand_loads, ros, [this](int count) { subscribers = count; },
            &changes) {}

  // A second of samples: longer than ramps and held peaks.
  const SceneState& RunOneSecond(const std::vector<int>& characters = {0}) {
    for (int i = 0; i < 60; ++i) {
      now += 1.0 / 60;
      for (const int character : characters) sink.OnSample(TPose(now, character));
    }
    return *last;
  }

  std::shared_ptr<const SceneState> last;
  HandLoadMailbox hand_loads;
  ChangeMailbox changes;
  SceneBuilder builder;
  Overload overload{/*may_skip=*/false};
  InputMerger sink;
  int subscribers = 0;  // of the ROS camera
  double now = 0;
};

TEST(HandLoads, ReachTheShoulderWithTheNextSamples) {
  Wired wired;
  wired.RunOneSecond();
  EXPECT_EQ(LoadOf(wired.last->people[0], urdf::jRightShoulder).load_class, LoadClass::kLow);
  EXPECT_EQ(wired.hand_loads.Put(0, HeldInRightHand(2)), "");
  const PersonState& person = wired.RunOneSecond().people[0];
  EXPECT_EQ(LoadOf(person, urdf::jRightShoulder).load_class, LoadClass::kMedium);
  EXPECT_EQ(LoadOf(person, urdf::jLeftShoulder).load_class, LoadClass::kLow);
  EXPECT_EQ(person.forces.hands[kRight].mass_kg, 2);
  EXPECT_EQ(person.forces.stated_hand_load.mass_kg[kRight], 2);
}

TEST(HandLoads, ApplyToOnePersonOnly) {
  Wired wired;
  EXPECT_EQ(wired.hand_loads.Put(1, HeldInRightHand(3)), "");
  const SceneState& scene = wired.RunOneSecond({0, 1});
  ASSERT_EQ(scene.people.size(), 2u);
  EXPECT_EQ(scene.people[0].forces.hands[kRight].mass_kg, 0);
  EXPECT_EQ(scene.people[1].forces.hands[kRight].mass_kg, 3);
}

TEST(HandLoads, OfOneHandReplaceThoseOfBothAndAreNotAdded) {
  Wired wired;
  HandLoad both;
  both.is_known = true;
  both.both_kg = 10;
  EXPECT_EQ(wired.hand_loads.Put(0, both), "");
  const BodyForces held = wired.RunOneSecond().people[0].forces;
  EXPECT_NEAR(held.hands[kRight].mass_kg + held.hands[urdf::kLeft].mass_kg, 10, 1e-9);
  EXPECT_EQ(wired.hand_loads.Put(0, HeldInRightHand(5)), "");
  const BodyForces& replaced = wired.RunOneSecond().people[0].forces;
  EXPECT_NEAR(replaced.hands[kRight].mass_kg, 5, 1e-9);
  EXPECT_NEAR(replaced.hands[urdf::kLeft].mass_kg, 0, 1e-9);
  EXPECT_EQ(replaced.stated_hand_load.both_kg, 0);
}

TEST(Changes, ReachThePersonAndTheLimitsWithTheNextSamples) {
  Wired wired;
  wired.RunOneSecond({0, 1});
  PersonChange change;
  change.mass_kg = 90;
  change.sex = urdf::Sex::kFemale;
  change.name = "Ann";
  wired.changes.Put(1, change);
  wired.changes.Put({0.05, 0.1});
  const SceneState& scene = wired.RunOneSecond({0, 1});
  EXPECT_EQ(scene.class_limits, (std::array<double, 2>{0.05, 0.1}));
  EXPECT_LT(scene.class_falls_below[1], 0.1);
  EXPECT_GT(scene.class_falls_below[1], 0.05);
  EXPECT_EQ(scene.people[0].model->description.mass_kg, 75);
  EXPECT_TRUE(scene.people[0].model->description.mass_is_assumed);
  const PersonState& ann = scene.people[1];
  EXPECT_EQ(ann.name, "Ann");
  EXPECT_EQ(ann.model->description.mass_kg, 90);
  EXPECT_FALSE(ann.model->description.mass_is_assumed);
  EXPECT_EQ(ann.model->description.sex, urdf::Sex::kFemale);
  EXPECT_NEAR(urdf::TotalMass(ann.model->human.body), 90, 1e-9);
  for (const PersonState& person : scene.people) {
    for (const JointLoad& load : person.loads) {
      if (!(load.shown_ratio > 0.2)) continue;
      EXPECT_EQ(load.load_class, LoadClass::kHigh) << load.joint;
    }
  }
  const double strength_of_men = LoadOf(scene.people[0], urdf::jRightShoulder).capacity;
  EXPECT_LT(LoadOf(ann, urdf::jRightShoulder).capacity, strength_of_men);
}

TEST(Changes, OfTheSexChangeAMassThatIsAssumedAndNoOther) {
  Wired wired;
  wired.RunOneSecond();
  PersonChange change;
  change.sex = urdf::Sex::kFemale;
  wired.changes.Put(0, change);
  const urdf::BodyDescription assumed = wired.RunOneSecond().people[0].model->description;
  EXPECT_EQ(assumed.mass_kg, urdf::DefaultMass(urdf::Sex::kFemale));
  EXPECT_TRUE(assumed.mass_is_assumed);
  change = {};
  change.mass_kg = 70;
  wired.changes.Put(0, change);
  change = {};
  change.sex = urdf::Sex::kMale;
  wired.changes.Put(0, change);
  const urdf::BodyDescription stated = wired.RunOneSecond().people[0].model->description;
  EXPECT_EQ(stated.mass_kg, 70);
  EXPECT_EQ(stated.sex, urdf::Sex::kMale);
}

TEST(Changes, OfAPersonAreCheckedAsTheOptionsAre) {
  PersonChange change;
  EXPECT_EQ(FindDefect(change), "");
  change.mass_kg = 301;
  EXPECT_NE(FindDefect(change), "");
  change.mass_kg = std::nan("");
  EXPECT_NE(FindDefect(change), "");
  change.mass_kg = 80;
  change.height_m = 0.4;
  EXPECT_NE(FindDefect(change), "");
  change.height_m = 1.8;
  EXPECT_EQ(FindDefect(change), "");
}

TEST(HandLoads, ChangeNothingIfTheyAreRejected) {
  Wired wired;
  EXPECT_EQ(wired.hand_loads.Put(0, HeldInRightHand(4)), "");
  for (const double wrong : {500.0, -1.0, std::nan("")}) {
    EXPECT_NE(wired.hand_loads.Put(0, HeldInRightHand(wrong)), "") << wrong;
  }
  EXPECT_EQ(wired.RunOneSecond().people[0].forces.hands[kRight].mass_kg, 4);
}

// A bridge that has something to say at every question.
class TellingBridge : public ros_bridge::RosBridge {
 public:
  void Publish(const SceneState&) override {}
  void PublishView(const ros_bridge::RosImage&) override {}
  void PublishDiagnostics(std::vector<ros_bridge::Diagnosis> /*all*/, double /*suit_hz*/) override {
  }
  bool PublishState(const std::string& /*state*/) override { return true; }
  bool PublishLog(const ros_bridge::RosLogLine& /*line*/) override { return true; }
  bool PublishMark(const ros_bridge::RosMark& /*mark*/) override { return true; }
  void TakeInputs(ros_bridge::InputSink& sink) override {
    if (measured) sink.OnMeasurements(0, *measured);
    if (load) sink.OnHandLoad(0, *load);
    if (markers) sink.OnMarkers(*std::exchange(markers, std::nullopt));
    if (listeners) sink.OnViewListeners(*std::exchange(listeners, std::nullopt));
  }
  ros_bridge::BridgeStatus status() const override { return {}; }
  std::optional<Measurements> measured;
  std::optional<HandLoad> load;
  std::optional<std::vector<std::shared_ptr<const SceneMarker>>> markers;
  std::optional<int> listeners;
};

TEST(InputMerger, AppliesAHandLoadOfRosBeforeTheSampleThatFollows) {
  TellingBridge bridge;
  Wired wired(&bridge);
  bridge.load = HeldInRightHand(2);
  wired.sink.OnSample(TPose(1));
  EXPECT_EQ(wired.last->people[0].forces.stated_hand_load.mass_kg[kRight], 2);
}

TEST(InputMerger, ForwardsTheNumberOfRosCameraSubscribersWithoutSamples) {
  TellingBridge bridge;
  Wired wired(&bridge);
  bridge.listeners = 3;
  wired.sink.TakeInputs();
  EXPECT_EQ(wired.subscribers, 3);
}

TEST(Markers, StayInTheSceneAndAppearAtOnceWithoutSamples) {
  TellingBridge bridge;
  Wired wired(&bridge);
  wired.builder.Start();
  const auto wall = std::make_shared<const SceneMarker>();
  bridge.markers.emplace(1, wall);
  wired.sink.TakeInputs();  // no sample has come
  ASSERT_EQ(wired.last->markers.size(), 1u);
  EXPECT_EQ(wired.last->markers[0], wall);
  EXPECT_EQ(wired.last->liveness, Liveness::kNoData);
  EXPECT_EQ(wired.RunOneSecond().markers.size(), 1u);
  const std::uint64_t live = wired.last->number;
  bridge.markers.emplace();
  wired.sink.TakeInputs();
  EXPECT_EQ(wired.last->number, live) << "the next sample brings it";
  EXPECT_TRUE(wired.RunOneSecond().markers.empty());
}

TEST(Measurements, ReplaceComputedLoadsWhileTheyAreValid) {
  TellingBridge bridge;
  Wired wired(&bridge);
  wired.RunOneSecond();
  bridge.measured.emplace();
  ExternalJointLoad& elbow = bridge.measured->joints[urdf::jRightElbow];
  elbow.ratio = 0.9;
  elbow.stamp_nanos = wired.last->stamp_nanos + 900'000'000;
  const PersonState during = wired.RunOneSecond().people[0];
  EXPECT_TRUE(LoadOf(during, urdf::jRightElbow).is_external);
  EXPECT_EQ(LoadOf(during, urdf::jRightElbow).load_class, LoadClass::kHigh);
  EXPECT_EQ(LoadOf(during, urdf::jRightElbow).ratio, 0.9);
  EXPECT_FALSE(LoadOf(during, urdf::jLeftElbow).is_external) << "per joint";
  EXPECT_TRUE(std::isfinite(LoadOf(during, urdf::jLeftElbow).ratio));
  const PersonState after = wired.RunOneSecond().people[0];
  EXPECT_FALSE(LoadOf(after, urdf::jRightElbow).is_external) << "it stopped";
  EXPECT_EQ(LoadOf(after, urdf::jRightElbow).load_class, LoadClass::kLow);
}

TEST(Measurements, LeaveAHandLoadUnknownAfterTheyStopUntilItIsSet) {
  TellingBridge bridge;
  Wired wired(&bridge);
  wired.RunOneSecond();
  MeasuredHandForce pull;
  pull.force = {0, 0, -20};
  pull.stamp_nanos = wired.last->stamp_nanos;
  bridge.measured.emplace().hands[kRight] = pull;
  const PersonState stopped = wired.RunOneSecond().people[0];
  EXPECT_EQ(LoadOf(stopped, urdf::jRightElbow).load_class, LoadClass::kUnknown);
  EXPECT_NE(LoadOf(stopped, urdf::jRightElbow).reason, "");
  EXPECT_EQ(wired.hand_loads.Put(0, HeldInRightHand(0)), "");
  const PersonState told = wired.RunOneSecond().people[0];
  EXPECT_EQ(LoadOf(told, urdf::jRightElbow).load_class, LoadClass::kLow)
      << LoadOf(told, urdf::jRightElbow).reason;
}

TEST(Measurements, OfTheCentreOfPressureMoveItAndKeepTheComputedForce) {
  TellingBridge bridge;
  Wired wired(&bridge);
  const PersonState before = wired.RunOneSecond().people[0];
  ASSERT_TRUE(before.cop);
  MeasuredGroundForce cop;
  cop.only_point = true;
  cop.point = *before.cop + Eigen::Vector3d(0.03, 0, 0);
  cop.stamp_nanos = wired.last->stamp_nanos + 1'000'000'000;
  bridge.measured.emplace().ground = cop;
  const PersonState during = wired.RunOneSecond().people[0];
  EXPECT_TRUE(during.forces.ground_is_measured);
  EXPECT_NEAR(during.cop->x() - before.cop->x(), 0.03, 1e-6);
  EXPECT_NEAR(during.forces.ground_force.z(), before.forces.ground_force.z(), 1);
}

TEST(Exposure, IsContainedInTheStates) {
  Wired wired;
  EXPECT_EQ(wired.hand_loads.Put(0, HeldInRightHand(2)), "");
  wired.RunOneSecond();
  const PersonState& person = wired.RunOneSecond().people[0];
  double sum = 0;
  const JointLoad& shoulder = LoadOf(person, urdf::jRightShoulder);
  for (const double secs : shoulder.band_secs) sum += secs;
  EXPECT_NEAR(sum, 2 - 1.0 / 60, 0.01);
  EXPECT_GT(shoulder.band_secs[static_cast<std::size_t>(LoadClass::kMedium)], 1);
}

// Other datagrams of the suit come between its samples, and each sample has waited a little.
TEST(Samples, MakeOneStateEach) {
  Wired wired;
  wired.RunOneSecond();
  const std::uint64_t before = wired.last->number;
  for (int i = 0; i < 10; ++i) {
    wired.now += 1.0 / 60;
    BodySample sample = TPose(wired.now, 0);
    sample.arrival_nanos = MonotonicNanos() - 1'000'000;
    wired.sink.OnSample(sample);
    wired.sink.AfterPoll();
    wired.sink.AfterPoll();
  }
  EXPECT_EQ(wired.last->number, before + 10);
}

TEST(Samples, OfWhichTheNewestWasSkippedAreShownWhenNoneWaitsAnyMore) {
  std::shared_ptr<const SceneState> last;
  SceneBuilder builder({}, "test", 0,
                       [&](std::shared_ptr<const SceneState> state) { last = std::move(state); });
  Overload overload(/*may_skip=*/true);
  HandLoadMailbox hand_loads;
  InputMerger sink(builder, overload, hand_loads, nullptr);
  const std::int64_t long_ago = MonotonicNanos() - 3 * kNanosPerSecond;
  BodySample sample = TPose(1);
  for (int i = 0; i < 10; ++i) {
    sample.counter = 100 + i;
    sample.stamp_nanos += kNanosPerSecond / 240;
    sample.arrival_nanos = long_ago + i;
    sink.OnSample(sample);
  }
  sink.AfterPoll();
  ASSERT_LT(last->counter, 109U) << "skipped";
  EXPECT_GT(last->waited_nanos, kOverloadNanos);
  sink.AfterPoll();
  EXPECT_EQ(last->counter, 109U);
  EXPECT_EQ(last->waited_nanos, 0) << "up to date";
}

}  // namespace
}  // namespace kinescope::app
