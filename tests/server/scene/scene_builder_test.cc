#include "server/scene/scene_builder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "server/subject/subject.h"
#include "tests/captured_log.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

using Eigen::Vector3d;
using ::testing::AllOf;
using ::testing::HasSubstr;

class Built {
 public:
  explicit Built(SceneOptions options = {})
      : builder(options, "test", 0, [this](std::shared_ptr<const SceneState> state) {
          states.push_back(std::move(state));
        }) {}
  const SceneState& last() const { return *states.back(); }

  std::vector<std::shared_ptr<const SceneState>> states;
  SceneBuilder builder;
};

BodySample SampleOf(const char* motion, double secs) {
  BodySample sample = subject::MakeMotion(motion)->At(secs);
  sample.stamp_nanos = std::llround(secs * 1e9) + 1;
  sample.arrival_nanos = sample.stamp_nanos;
  return sample;
}

TEST(SceneBuilder, ReportsNoDataBeforeTheFirstSample) {
  Built built;
  built.builder.Start();
  EXPECT_EQ(built.last().liveness, Liveness::kNoData);
  EXPECT_TRUE(built.last().people.empty());
  EXPECT_EQ(built.last().source, "test");
}

TEST(SceneBuilder, StandsRobotsOnTheFloorAndCountsTheChangesBesideThePeople) {
  SceneOptions options;
  options.floor_z = -0.75;
  Built built(options);
  RobotState robot;
  robot.model = std::make_shared<urdf::RobotModel>();
  robot.world_from_link = {Eigen::Isometry3d(Eigen::Translation3d(1, 2, 3))};
  built.builder.SetRobots({robot});
  built.builder.Start();
  built.builder.OnSample(SampleOf("lift", 0));
  ASSERT_EQ(built.last().robots.size(), 1u);
  EXPECT_EQ(built.last().robots[0].world_from_link[0].translation(), Vector3d(1, 2, 2.25));
  const std::uint64_t before = built.last().surroundings;
  EXPECT_GT(before, 0u);
  built.builder.OnSample(SampleOf("lift", 1));
  EXPECT_EQ(built.last().surroundings, before) << "nothing has changed";
  built.builder.SetMarkers({std::make_shared<const SceneMarker>()});
  built.builder.OnSample(SampleOf("lift", 2));
  EXPECT_EQ(built.last().surroundings, before + 1);
}

TEST(SceneBuilder, KnowsOfPeopleWhatTheNodeOfTheirSuitWasToldUnlessOptionsOrOperatorsSayMore) {
  const auto person = [](const Built& built) -> const PersonState& {
    return built.last().people[0];
  };
  const auto show = [](Built& built, double secs) {
    built.builder.OnSample(SampleOf("lift", secs));
  };
  Character character;
  character.told.mass_kg = 90;
  character.told.sex = urdf::Sex::kFemale;
  character.told_hand_load.is_known = true;
  character.told_hand_load.both_kg = 8;
  Built built;
  built.builder.OnCharacter(character);
  show(built, 0);
  EXPECT_EQ(person(built).model->description.mass_kg, 90);
  EXPECT_FALSE(person(built).model->description.mass_is_assumed);
  EXPECT_EQ(person(built).model->description.sex, urdf::Sex::kFemale);
  EXPECT_EQ(person(built).forces.stated_hand_load.both_kg, 8);
  character.told.mass_kg = 91;
  character.told_hand_load.both_kg = 4;
  built.builder.OnCharacter(character);
  show(built, 0.1);
  EXPECT_EQ(person(built).model->description.mass_kg, 91);
  EXPECT_EQ(person(built).forces.stated_hand_load.both_kg, 4);
  PersonChange operators;
  operators.mass_kg = 60;
  built.builder.ChangePerson(0, operators);
  HandLoad none;
  none.is_known = true;
  built.builder.SetHandLoad(0, none);
  built.builder.OnCharacter(character);
  show(built, 0.2);
  EXPECT_EQ(person(built).model->description.mass_kg, 60);
  EXPECT_EQ(person(built).forces.stated_hand_load.both_kg, 0);

  SceneOptions varied;
  varied.supposed.mass_factor = 1.1;
  varied.supposed.hand_load_factor = 0.5;
  varied.supposed.hand_load.is_known = true;
  varied.supposed.hand_load.both_kg = 5;
  Built supposed(varied);
  supposed.builder.OnCharacter(character);
  show(supposed, 0);
  EXPECT_NEAR(person(supposed).model->description.mass_kg, 1.1 * 91, 1e-9);
  EXPECT_EQ(person(supposed).forces.stated_hand_load.both_kg, 2);
  Built nothing_told(varied);
  show(nothing_told, 0);
  EXPECT_TRUE(person(nothing_told).model->description.mass_is_assumed);
  EXPECT_EQ(person(nothing_told).forces.stated_hand_load.both_kg, 5);

  SceneOptions options;
  options.body.mass_kg = 70;
  options.body.mass_is_assumed = false;
  options.loads.hands.is_known = true;
  options.loads.hands.mass_kg[urdf::kLeft] = 2;
  Built with_options(options);
  with_options.builder.OnCharacter(character);
  show(with_options, 0);
  EXPECT_EQ(person(with_options).model->description.mass_kg, 70);
  EXPECT_EQ(person(with_options).model->description.sex, urdf::Sex::kFemale);
  EXPECT_EQ(person(with_options).forces.stated_hand_load.mass_kg[urdf::kLeft], 2);
  EXPECT_EQ(person(with_options).forces.stated_hand_load.both_kg, 0);
}

TEST(SceneBuilder, DoesNotUseWhatCannotBeTrueOfAPerson) {
  Character character;
  character.name = "anna";
  character.told.mass_kg = 900;
  character.told_hand_load.is_known = true;
  character.told_hand_load.mass_kg[urdf::kLeft] = -1;
  const kinescope::testing::CapturedLog log;
  Built built;
  built.builder.OnCharacter(character);
  built.builder.OnCharacter(character);
  built.builder.OnSample(SampleOf("lift", 0));
  EXPECT_TRUE(built.last().people[0].model->description.mass_is_assumed);
  EXPECT_FALSE(built.last().people[0].forces.stated_hand_load.is_known);
  const std::string text = log.text();
  const std::string said = "what the node of the suit was told about 'anna' is not used: ";
  EXPECT_THAT(text, AllOf(HasSubstr(said + "body mass 900"),
                          HasSubstr(said + "load of -1 kg in the left hand")));
  EXPECT_EQ(text.find("900"), text.rfind("900")) << "once";

  Character good;
  good.told.mass_kg = 80;
  built.builder.OnCharacter(good);
  built.builder.OnCharacter(character);
  built.builder.OnSample(SampleOf("lift", 0.1));
  EXPECT_EQ(built.last().people[0].model->description.mass_kg, 80) << "what was known stays";
}

SourceMoment LiveMoment(double secs) {
  const std::int64_t nanos = std::llround(secs * 1e9) + 1;
  return {nanos, nanos};
}

std::shared_ptr<const RobotState> ArmAt(const Vector3d& place) {
  RobotState arm;
  arm.model = std::make_shared<urdf::RobotModel>();
  arm.moves = true;
  arm.world_from_link = {Eigen::Isometry3d(Eigen::Translation3d(place))};
  arm.bounds = {place, place + Vector3d(0, 0, 1)};
  return std::make_shared<const RobotState>(arm);
}

TEST(SceneBuilder, WithoutAPersonShowsWhatElseIsThere) {
  Built built;
  built.builder.Start();
  built.builder.OnMoment(LiveMoment(1));
  EXPECT_EQ(built.last().liveness, Liveness::kNoData) << "there is nothing";
  built.builder.SetMovingRobots({ArmAt({3, 0, 0})});
  built.builder.OnMoment(LiveMoment(2));
  EXPECT_EQ(built.last().liveness, Liveness::kNoPerson);
  EXPECT_EQ(built.last().stamp_nanos, LiveMoment(2).stamp_nanos);
  EXPECT_EQ(built.last().extent.max(), Vector3d(3, 0, 1));
  built.builder.SetMovingRobots({ArmAt({9, 0, 0})});
  built.builder.OnMoment(LiveMoment(2.5));
  EXPECT_EQ(built.last().time_code_millis, 500);
  EXPECT_EQ(built.last().counter, 1u);
  EXPECT_GT(built.last().extent.max().x(), 9);
  built.builder.SetMovingRobots({});
  built.builder.OnMoment(LiveMoment(3));
  EXPECT_EQ(built.last().liveness, Liveness::kNoPerson) << "what there was may come again";

  built.builder.Tick(LiveMoment(3.4).arrival_nanos);
  EXPECT_EQ(built.last().liveness, Liveness::kNoPerson);
  built.builder.Tick(LiveMoment(3.6).arrival_nanos);
  EXPECT_EQ(built.last().liveness, Liveness::kStale);
  built.builder.OnMoment(LiveMoment(4));
  EXPECT_EQ(built.last().liveness, Liveness::kNoPerson);

  built.builder.OnSample(SampleOf("lift", 5));
  EXPECT_EQ(built.last().liveness, Liveness::kLive);
  EXPECT_TRUE(built.last().extent.isEmpty()) << "people are framed";
}

TEST(SceneBuilder, GoesOnWithWhatElseARecordingHasWhenPeopleHaveLeft) {
  Built built;
  built.builder.Start();
  BodySample sample = SampleOf("lift", 5);
  sample.arrival_nanos = 0;
  sample.time_code_millis = 7000;
  built.builder.OnSample(sample);
  built.builder.OnSurroundings({{}, {ArmAt({3, 0, 0})}, {}});
  built.builder.OnMoment({sample.stamp_nanos + 600'000'000, 0});
  EXPECT_EQ(built.last().liveness, Liveness::kStale);
  EXPECT_EQ(built.last().people.size(), 1u) << "where they were last";
  EXPECT_EQ(built.last().counter, sample.counter);
  built.builder.OnMoment({sample.stamp_nanos + 1'100'000'000, 0});
  EXPECT_EQ(built.last().liveness, Liveness::kNoPerson);
  EXPECT_EQ(built.last().rate_hz, 0);
  EXPECT_TRUE(built.last().people.empty());
  EXPECT_EQ(built.last().robots.size(), 1u);
  EXPECT_EQ(built.last().time_code_millis, 8100) << "as those of the samples";
  EXPECT_TRUE(built.last().extent.isEmpty()) << "the camera stays where it was";
  sample.stamp_nanos += 2'000'000'000;
  sample.time_code_millis = 9000;
  built.builder.OnSample(sample);
  EXPECT_EQ(built.last().liveness, Liveness::kLive);
  EXPECT_EQ(built.last().people.size(), 1u);
}

TEST(SceneBuilder, HasTheMomentsOfARecordingFromItsBeginning) {
  Built built;
  built.builder.Start();
  built.builder.OnMoment({1'000'000'000, 0});
  EXPECT_EQ(built.last().liveness, Liveness::kNoPerson);
  EXPECT_EQ(built.last().counter, 0u);
  EXPECT_TRUE(built.last().extent.isEmpty());
}

TEST(SceneBuilder, HasRobotsThatMoveWhereTheyAreInEachState) {
  Built built;
  auto arm = std::make_shared<RobotState>();
  arm->model = std::make_shared<urdf::RobotModel>();
  arm->moves = true;
  arm->world_from_link = {Eigen::Isometry3d(Eigen::Translation3d(1, 2, 3))};
  built.builder.OnSurroundings({{}, {arm}, {}});
  built.builder.OnSample(SampleOf("lift", 0));
  ASSERT_EQ(built.last().robots.size(), 1u);
  EXPECT_EQ(built.last().robots[0].world_from_link[0].translation(), Vector3d(1, 2, 3));
  const std::uint64_t before = built.last().surroundings;
  EXPECT_GT(before, 0u);
  auto moved = std::make_shared<RobotState>(*arm);
  moved->world_from_link[0].pretranslate(Vector3d(0, 0, 1));
  built.builder.OnSurroundings({{}, {moved}, {}});
  built.builder.OnSample(SampleOf("lift", 1));
  EXPECT_EQ(built.last().robots[0].world_from_link[0].translation(), Vector3d(1, 2, 4));
  EXPECT_EQ(built.last().surroundings, before) << "its shape is the same";
  auto other = std::make_shared<RobotState>(*arm);
  other->problem = "a link is nowhere";
  built.builder.SetMovingRobots({other});
  built.builder.OnSample(SampleOf("lift", 2));
  EXPECT_EQ(built.last().robots.size(), 2u) << "of the recording, and of other nodes";
  EXPECT_EQ(built.last().surroundings, before + 1);
}

TEST(SceneBuilder, HasTheFrameThatTheCameraGoesWith) {
  SceneOptions options;
  options.camera_frame.at = "skeleton_head";
  Built of_person(options);
  of_person.builder.OnSample(SampleOf("lift", 0));
  const SceneState& state = of_person.last();
  ASSERT_EQ(state.people.at(0).model->human.model_name, "skeleton");
  EXPECT_EQ(state.camera_base.value().position,
            state.people[0].links[urdf::At(urdf::kHead)].position);
  options.camera_frame.at = "cart";
  Built of_tf(options);
  of_tf.builder.OnSample(SampleOf("lift", 0));
  EXPECT_FALSE(of_tf.last().camera_base);
  of_tf.builder.OnSurroundings({{}, {}, {}, urdf::Pose{Vector3d(1, 2, 3), {1, 0, 0, 0}}});
  of_tf.builder.OnSample(SampleOf("lift", 1));
  EXPECT_EQ(of_tf.last().camera_base.value().position, Vector3d(1, 2, 3));
  of_tf.builder.OnSurroundings({});
  of_tf.builder.SetCameraBase({Vector3d(4, 5, 6), {1, 0, 0, 0}});
  of_tf.builder.OnSample(SampleOf("lift", 2));
  EXPECT_EQ(of_tf.last().camera_base.value().position, Vector3d(4, 5, 6));
}

TEST(SceneBuilder, TurnsTheCameraThatGoesWithAPersonAsItsAxesAre) {
  SceneOptions options;
  options.camera_frame = {"skeleton_head", "lab"};
  Built built(options);
  built.builder.OnSample(SampleOf("lift", 0));
  EXPECT_TRUE(
      built.last().camera_base.value().orientation.isApprox(Eigen::Quaterniond::Identity()));
  const Eigen::Quaterniond turn(0, 0, 0, 1);
  built.builder.SetCameraBase({Vector3d(4, 5, 6), turn});
  built.builder.OnSample(SampleOf("lift", 1));
  const SceneState& state = built.last();
  EXPECT_TRUE(state.camera_base.value().orientation.isApprox(turn));
  EXPECT_EQ(state.camera_base->position, state.people[0].links[urdf::At(urdf::kHead)].position);
}

TEST(SceneBuilder, SaysOnceThatTheFrameOfTheCameraDoesNotCome) {
  SceneOptions options;
  options.camera_frame.at = "moon";
  const kinescope::testing::CapturedLog log;
  for (int i = 0; i < 2; ++i) {
    Built built(options);
    built.builder.OnSample(SampleOf("lift", 0));
  }
  const std::string said = log.text();
  const std::size_t first = said.find("frame 'moon' of the camera");
  ASSERT_NE(first, std::string::npos) << said;
  EXPECT_EQ(said.find("frame 'moon'", first + 1), std::string::npos) << said;
}

TEST(SceneBuilder, ShowsTheMarkersOfARecordingWithItsSamplesBesideThoseOfOtherNodes) {
  const auto recorded = std::make_shared<const SceneMarker>();
  const auto of_a_node = std::make_shared<const SceneMarker>();
  Built built;
  built.builder.OnSurroundings({{recorded}, {}, {}});
  EXPECT_TRUE(built.states.empty()) << "a picture of no person";
  built.builder.OnSample(SampleOf("lift", 0));
  EXPECT_EQ(built.last().markers, MarkerList{recorded});
  built.builder.SetMarkers({of_a_node});
  built.builder.OnSample(SampleOf("lift", 1));
  EXPECT_EQ(built.last().markers, (MarkerList{recorded, of_a_node}));
  built.builder.OnSurroundings({});
  built.builder.OnSample(SampleOf("lift", 2));
  EXPECT_EQ(built.last().markers, MarkerList{of_a_node});
}

TEST(SceneBuilder, ShowsPicturesOfCamerasFourAtMostAndCallsThemNoNews) {
  const auto picture = [] { return std::make_shared<const CameraImage>(); };
  const ImageList recorded = {picture()}, of_nodes = {picture(), picture(), picture(), picture()};
  Built built;
  built.builder.OnSample(SampleOf("lift", 0));
  const std::uint64_t before = built.last().surroundings;
  built.builder.OnSurroundings({{}, {}, recorded});
  built.builder.SetImages(of_nodes);
  built.builder.OnSample(SampleOf("lift", 1));
  EXPECT_EQ(built.last().images, (ImageList{recorded[0], of_nodes[0], of_nodes[1], of_nodes[2]}));
  EXPECT_EQ(built.last().surroundings, before) << "the page need not load triangles anew";
}

TEST(SceneBuilder, HasTheHeadingOfLiveViewsInEveryState) {
  const auto turned = [](double secs) {
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(M_PI, Vector3d::UnitZ()));
    BodySample sample = SampleOf("lift", secs);
    for (auto& segment : sample.segments) {
      segment.position = turn * segment.position;
      segment.orientation = turn * segment.orientation;
    }
    return sample;
  };
  Built of_files;
  of_files.builder.OnSample(turned(0));
  EXPECT_EQ(of_files.last().view_heading, 0);
  SceneOptions options;
  options.view_frame = CameraFrame::kStart;
  Built live(options);
  live.builder.Start();
  EXPECT_EQ(live.last().view_heading, 0);
  for (const double secs : {0.0, 0.1, 0.2}) live.builder.OnSample(turned(secs));
  EXPECT_NEAR(std::abs(live.last().view_heading), M_PI, 1e-9);
  live.builder.MarkStale();
  EXPECT_NEAR(std::abs(live.last().view_heading), M_PI, 1e-9);
}

TEST(SceneBuilder, ConvertsTheArmsOfTheStreamToLinkFrames) {
  Built built;
  built.builder.OnSample(SampleOf("n_pose", 0));
  const PersonState& person = built.last().people.at(0);
  for (int i = 0; i < urdf::kSegmentCount; ++i) {
    const Vector3d up = person.links[static_cast<std::size_t>(i)].orientation * Vector3d::UnitZ();
    EXPECT_GT(up.z(), 0.95) << urdf::kSegments[static_cast<std::size_t>(i)].link_name
                            << " is not upright in the N-pose";
  }
}

TEST(SceneBuilder, PublishesAnglesThatRestoreThePose) {
  Built built;
  for (const double secs : {0.0, 1.0, 2.0, 3.0}) {
    built.builder.OnSample(SampleOf("lift", secs));
    const PersonState& person = built.last().people.at(0);
    const urdf::LinkPoses rebuilt =
        urdf::ForwardKinematics(urdf::DefaultSkeleton(), person.links[0], person.angles);
    for (std::size_t i = 0; i < rebuilt.size(); ++i) {
      EXPECT_LT(rebuilt[i].orientation.angularDistance(person.links[i].orientation), 1e-6);
      EXPECT_LT((rebuilt[i].position - person.links[i].position).norm(), 1e-6);
    }
  }
}

TEST(SceneBuilder, BecomesStaleWhenTheStreamStopsAndLiveWhenItContinues) {
  Built built;
  BodySample sample = SampleOf("lift", 2);
  built.builder.OnSample(sample);
  built.builder.Tick(sample.arrival_nanos + 400'000'000);
  EXPECT_EQ(built.last().liveness, Liveness::kLive);
  built.builder.Tick(sample.arrival_nanos + 500'000'000);
  EXPECT_EQ(built.last().liveness, Liveness::kStale);
  for (const JointLoad& load : built.last().people.at(0).loads) {
    EXPECT_EQ(load.load_class, LoadClass::kUnknown);
    EXPECT_TRUE(std::isnan(load.ratio));
    EXPECT_EQ(load.reason, "the stream stopped");
  }
  const BodyForces& forces = built.last().people.at(0).forces;
  EXPECT_TRUE(std::isnan(forces.joints[urdf::jL5S1].moment.y()));
  EXPECT_EQ(forces.why_no_ground, "the stream stopped");
  EXPECT_FALSE(forces.lumbar);
  const std::size_t states = built.states.size();
  built.builder.Tick(sample.arrival_nanos + 900'000'000);
  EXPECT_EQ(built.states.size(), states) << "stale is said once";
  sample.stamp_nanos += 2'000'000'000;
  sample.arrival_nanos += 2'000'000'000;
  built.builder.OnSample(sample);
  EXPECT_EQ(built.last().liveness, Liveness::kLive);
}

TEST(SceneBuilder, IsNotStaleWhileOldSamplesAreProcessed) {
  Built built;
  constexpr std::int64_t kWaited = 3'700'000'000;
  BodySample sample = SampleOf("lift", 2);
  built.builder.SetWaited(kWaited);
  built.builder.OnSample(sample);
  built.builder.Tick(sample.arrival_nanos + kWaited + 400'000'000);
  EXPECT_EQ(built.last().liveness, Liveness::kLive);
  EXPECT_EQ(built.last().waited_nanos, kWaited);
  built.builder.Tick(sample.arrival_nanos + kWaited + 500'000'000);
  EXPECT_EQ(built.last().liveness, Liveness::kStale);
}

TEST(SceneBuilder, UpdatesTheBodyWhenScaleDataArrive) {
  Built built;
  built.builder.OnSample(SampleOf("n_pose", 0));
  const auto before = built.last().people.at(0).model;
  Character tall;
  tall.name = "Anna";
  tall.skeleton = urdf::DefaultSkeleton(1.95);
  built.builder.OnCharacter(tall);
  built.builder.OnSample(SampleOf("n_pose", 0.1));
  const PersonState& person = built.last().people.at(0);
  EXPECT_EQ(person.name, "Anna");
  EXPECT_GT(person.model->revision, before->revision);
  EXPECT_DOUBLE_EQ(person.model->human.skeleton.height, 1.95);
  built.builder.OnCharacter(tall);
  built.builder.OnSample(SampleOf("n_pose", 0.2));
  EXPECT_EQ(built.last().people.at(0).model, person.model) << "the same body again is no news";
}

// Everything that a stream says about a body, changed with every sample.
Character Restless(int i) {
  Character character;
  character.name = "N" + std::to_string(i);
  character.color_rgb = static_cast<std::uint32_t>(i * 7919 % 0x1000000);
  character.skeleton = urdf::DefaultSkeleton(1.6 + 0.0005 * (i % 500));
  return character;
}

TEST(SceneBuilder, MakesChangedBodiesAsideAndUsesTheNewestWhenItIsReady) {
  SceneOptions options;
  options.makes_models_aside = true;
  Built built(options);
  constexpr int kSamples = 400;
  std::set<const PersonModel*> models;
  for (int i = 0; i <= kSamples; ++i) {
    built.builder.OnCharacter(Restless(i));
    built.builder.OnSample(SampleOf("n_pose", 0.001 * i));
    models.insert(built.last().people.at(0).model.get());
    EXPECT_EQ(built.last().people.at(0).name, Restless(i).name) << "a name needs no model";
  }
  // One at once, one ordered with the next sample, others only after a pause.
  EXPECT_LE(models.size(), 20U) << "of " << kSamples << " bodies";
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  const auto height = [&] { return built.last().people.at(0).model->human.skeleton.height; };
  for (int i = 1; height() != Restless(kSamples).skeleton->height; ++i) {
    ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "still " << height() << " m";
    built.builder.OnSample(SampleOf("n_pose", 0.001 * (kSamples + i)));
    std::this_thread::yield();
  }
  EXPECT_EQ(built.last().people.at(0).model->color_rgb, Restless(kSamples).color_rgb);
}

TEST(SceneBuilder, KeepsGlovesOutUntilTheBodyHasThem) {
  SceneOptions options;
  options.makes_models_aside = true;
  Built built(options);
  built.builder.OnSample(SampleOf("n_pose", 0));
  BodySample gloved = SampleOf("n_pose", 0.01);
  for (std::size_t i = 0; i < gloved.fingers_and_props.poses.size(); ++i) {
    gloved.fingers_and_props.present.set(i);
    gloved.fingers_and_props.poses[i].position = gloved.segments[urdf::kRightHand].position;
  }
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  do {
    ASSERT_LT(std::chrono::steady_clock::now(), deadline);
    gloved.stamp_nanos += 1'000'000;
    built.builder.OnSample(gloved);
    const PersonState& person = built.last().people.at(0);
    for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
      EXPECT_EQ(person.gloves[side].has_value(), person.model->human.gloves[side].has_value());
    }
    for (std::size_t prop = 0; prop < kMaxProps; ++prop) {
      EXPECT_EQ(person.props[prop].has_value(), person.model->human.props.test(prop));
    }
    std::this_thread::yield();
  } while (!built.last().people.at(0).gloves[urdf::kRight]);
}

TEST(SceneBuilder, MakesNoPersonOfADescriptionAlone) {
  Built built;
  for (int i = 0; i < 256; ++i) {
    Character character = Restless(i);
    character.id = i;
    built.builder.OnCharacter(character);
  }
  built.builder.OnSample(SampleOf("n_pose", 0));
  ASSERT_EQ(built.last().people.size(), 1U);
  EXPECT_EQ(built.last().people[0].name, "N0");
  EXPECT_EQ(built.last().people[0].model->human.model_name, "skeleton") << "the first to appear";
}

BodySample Moved(BodySample sample, int character, double x) {
  sample.character = character;
  for (SegmentState& segment : sample.segments) segment.position.x() += x;
  return sample;
}

TEST(SceneBuilder, LeavesOutWhoeverIsFarFromTheOthersAndSaysSo) {
  Built built;
  Character eve;
  eve.id = 1;
  eve.name = "Eve";
  built.builder.OnCharacter(eve);
  built.builder.OnSample(Moved(SampleOf("n_pose", 0), 1, 900e3));  // alone: anybody may be anywhere
  EXPECT_EQ(built.last().people.size(), 1U);
  built.builder.OnSample(SampleOf("n_pose", 0.01));
  built.builder.OnSample(Moved(SampleOf("n_pose", 0.02), 1, 900e3));
  for (double secs = 1; secs < 3; secs += 0.1) {
    built.builder.OnSample(SampleOf("n_pose", secs));
    built.builder.OnSample(Moved(SampleOf("n_pose", secs + 0.05), 1, 900e3));
    ASSERT_EQ(built.last().people.size(), 1U) << secs;
    EXPECT_EQ(built.last().people[0].character, 0) << "nearer to the origin";
    ASSERT_EQ(built.last().left_out.size(), 1U);
    EXPECT_EQ(built.last().left_out[0].name, "Eve");
    EXPECT_EQ(built.last().left_out[0].why, "900 km from the others");
  }
  built.builder.OnSample(Moved(SampleOf("n_pose", 3.1), 1, 2));
  built.builder.OnSample(SampleOf("n_pose", 3.2));
  EXPECT_TRUE(built.last().left_out.empty());
  EXPECT_EQ(built.last().people.size(), 2U) << "never was at 900 km";
}

TEST(SceneBuilder, FollowsAPersonWhoStaysFarAway) {
  Built built;
  for (int i = 0; i < 10; ++i) built.builder.OnSample(SampleOf("n_pose", 0.1 * i));
  for (int i = 10; i < 39; ++i) {
    built.builder.OnSample(Moved(SampleOf("n_pose", 0.1 * i), 0, 5e3));
    ASSERT_EQ(built.last().left_out.size(), 1U) << i;
    EXPECT_EQ(built.last().left_out[0].why, "5.0 km from where it was");
    EXPECT_EQ(built.last().liveness, Liveness::kLive) << "samples come";
    EXPECT_EQ(built.last().people.size(), i <= 19 ? 1U : 0U) << "shown there for a second";
  }
  built.builder.OnSample(Moved(SampleOf("n_pose", 4.1), 0, 5e3));
  EXPECT_TRUE(built.last().left_out.empty()) << "it has stayed";
  EXPECT_GT(built.last().people.at(0).links[0].position.x(), 4e3);
}

TEST(SceneBuilder, LosesNothingAfterAWrongFirstPosition) {
  Built recording;
  recording.builder.OnSample(Moved(SampleOf("n_pose", 0), 0, 5e3));
  recording.builder.OnSample(SampleOf("n_pose", 0.1));
  EXPECT_TRUE(recording.last().left_out.empty());
  EXPECT_LT(recording.last().people.at(0).links[0].position.x(), 1);
  Built live;  // somebody used the suit's number, and has gone
  for (int i = 0; i < 10; ++i) {
    live.builder.OnSample(Moved(SampleOf("n_pose", 0.01 * i), 0, 900e3));
  }
  live.builder.OnSample(SampleOf("n_pose", 4));
  EXPECT_TRUE(live.last().left_out.empty());
  EXPECT_LT(live.last().people.at(0).links[0].position.x(), 1);
}

TEST(SceneBuilder, RemovesThoseGoneAlsoAfterTheClockWasSetBack) {
  Built built;
  BodySample gone = SampleOf("n_pose", 7200);
  gone.character = 1;
  built.builder.OnSample(gone);
  built.builder.OnSample(SampleOf("n_pose", 3600));
  ASSERT_EQ(built.last().people.size(), 1U);
  EXPECT_EQ(built.last().people[0].character, 0);
}

TEST(SceneBuilder, ShowsNoOldBodyOfAPersonWhoReturns) {
  SceneOptions options;
  options.makes_models_aside = true;
  Built built(options);
  built.builder.OnSample(SampleOf("n_pose", 0));
  built.builder.OnCharacter(Restless(1));
  built.builder.OnSample(SampleOf("n_pose", 0.1));  // orders a body, and leaves
  BodySample other = SampleOf("n_pose", 100);
  other.character = 5;
  built.builder.OnSample(other);
  built.builder.OnCharacter(Restless(2));
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::milliseconds(300);
  for (int i = 0; std::chrono::steady_clock::now() < deadline; ++i) {
    built.builder.OnSample(SampleOf("n_pose", 101 + 0.001 * i));
    ASSERT_EQ(built.last().people.at(0).model->color_rgb, Restless(2).color_rgb);
  }
}

TEST(SceneBuilder, LeavesOutOneWrongPositionOfAPersonAlone) {
  Built built;
  for (int i = 0; i < 3; ++i) built.builder.OnSample(SampleOf("n_pose", 0.1 * i));
  built.builder.OnSample(Moved(SampleOf("n_pose", 0.3), 0, 900e3));
  EXPECT_LT(built.last().people.at(0).links[0].position.x(), 1);
  ASSERT_EQ(built.last().left_out.size(), 1U);
  built.builder.OnSample(SampleOf("n_pose", 0.4));
  EXPECT_TRUE(built.last().left_out.empty());
  EXPECT_LT(built.last().people.at(0).links[0].position.x(), 1);
}

TEST(SceneBuilder, IsNotTalkedOutOfAPersonByTheMajority) {
  Built built;
  for (double secs = 0; secs < 1; secs += 0.1) {
    for (int i = 0; i < 10; ++i) {
      built.builder.OnSample(Moved(SampleOf("n_pose", secs + 0.01), 1 + i, 50e3 + i));
    }
    built.builder.OnSample(SampleOf("n_pose", secs));
  }
  EXPECT_EQ(built.last().left_out.size(), 10U);
  ASSERT_FALSE(built.last().people.empty());
  EXPECT_EQ(built.last().people[0].character, 0);
}

TEST(SceneBuilder, GivesBackTheMemoryOfPeopleWhoLeftAndKnowsThemWhenTheyReturn) {
  Built built;
  const auto stay = [&](int character, double from, double to) {
    for (double secs = from; secs < to; secs += 0.1) {
      BodySample sample = SampleOf("t_pose", secs);
      sample.character = character;
      built.builder.OnSample(sample);
    }
    built.states.erase(built.states.begin(), built.states.end() - 1);
  };
  stay(0, 0, 5);
  const auto secs_of = [&] {
    const auto& band = built.last().people.at(0).loads.at(0).band_secs;
    return std::accumulate(band.begin(), band.end(), 0.0);
  };
  EXPECT_NEAR(secs_of(), 4.9, 0.2);
  const std::weak_ptr<const PersonModel> model = built.last().people.at(0).model;
  const std::uint64_t revision = built.last().people.at(0).model->revision;
  stay(1, 5, 8);
  EXPECT_FALSE(model.expired()) << "may come back";
  stay(1, 66, 67);
  EXPECT_TRUE(model.expired());
  stay(0, 67, 69);
  EXPECT_EQ(built.last().people.at(0).model->human.model_name, "skeleton") << "as before";
  EXPECT_NEAR(secs_of(), 6.8, 0.4) << "exposure goes on";
  EXPECT_GT(built.last().people.at(0).model->revision, revision) << "sinks must not mistake it";
}

TEST(SceneBuilder, DistinguishesTwoPeople) {
  Built built;
  BodySample second = SampleOf("walk", 0);
  second.character = 3;
  built.builder.OnSample(SampleOf("n_pose", 0));
  built.builder.OnSample(second);
  ASSERT_EQ(built.last().people.size(), 2u);
  EXPECT_EQ(built.last().people[0].model->human.model_name, "skeleton");
  EXPECT_EQ(built.last().people[1].model->human.model_name, "skeleton_1");
}

// In ROS the first of them has the names without a prefix.
TEST(SceneBuilder, CountsPeopleInTheOrderInWhichTheyCome) {
  Built built;
  BodySample ben = SampleOf("n_pose", 0), anna = SampleOf("walk", 0);
  ben.character = 1;
  built.builder.OnSample(ben);
  built.builder.OnSample(anna);
  ASSERT_EQ(built.last().people.size(), 2u);
  EXPECT_EQ(built.last().people[0].character, 0);
  EXPECT_EQ(built.last().people[0].model->index, 1);
  EXPECT_EQ(built.last().people[1].model->index, 0);
}

TEST(SceneBuilder, NamesLinksAfterPeopleIfTold) {
  SceneOptions options;
  options.takes_names = true;
  Built built(options);
  const char* const names[] = {"anna", "lab/ben", "carl"};
  for (int person = 0; person < 3; ++person) {
    Character character;
    character.id = person;
    character.name = names[person];
    built.builder.OnCharacter(character);
    BodySample sample = SampleOf("n_pose", 0);
    sample.character = person;
    built.builder.OnSample(sample);
  }
  ASSERT_EQ(built.last().people.size(), 3u);
  const auto name = [&](std::size_t i) { return built.last().people[i].model->human.model_name; };
  EXPECT_EQ(name(0), "anna");
  EXPECT_EQ(name(1), "skeleton_1") << "a link cannot be called so";
  EXPECT_EQ(name(2), "carl");
}

TEST(SceneBuilder, RemovesAPersonWhoLeft) {
  Built built;
  built.builder.OnSample(SampleOf("n_pose", 0));
  BodySample second = SampleOf("walk", 2);
  second.character = 3;
  built.builder.OnSample(second);
  ASSERT_EQ(built.last().people.size(), 1u);
  EXPECT_EQ(built.last().people[0].character, 3);
}

TEST(SceneBuilder, ReportsUnknownLegLoadsOfARecordingWithoutLegs) {
  Built built;
  BodySample sample = SampleOf("n_pose", 0);
  const double pelvis = sample.segments[0].position.z();
  for (SegmentState& segment : sample.segments) segment.position.z() -= pelvis;
  built.builder.OnSample(sample);
  EXPECT_LT(built.last().floor_z, -0.7);
  const PersonState& person = built.last().people.at(0);
  EXPECT_FALSE(person.cop);
  for (const JointLoad& load : person.loads) {
    const bool is_leg = load.joint >= urdf::jRightHip;
    EXPECT_EQ(load.load_class == LoadClass::kUnknown, is_leg);
    EXPECT_EQ(load.reason.empty(), !is_leg);
  }
}

// Ten seconds of walking, lifted as a whole.
std::vector<std::shared_ptr<const SceneState>> WalkAt(double z,
                                                      std::optional<double> floor_z = {}) {
  SceneOptions options;
  options.floor_z = floor_z;
  Built built(options);
  const auto motion = subject::MakeMotion("walk");
  built.builder.OnCharacter(motion->character());
  for (int i = 0; i < 600; ++i) {
    BodySample sample = motion->At(i / 60.0);
    sample.stamp_nanos = std::llround(i * 1e9 / 60) + 1;
    for (SegmentState& segment : sample.segments) segment.position.z() += z;
    if (sample.com) sample.com->position.z() += z;
    built.builder.OnSample(sample);
  }
  return built.states;
}

TEST(SceneBuilder, FindsTheFloorUnderAPersonAtAnyHeight) {
  const auto at_zero = WalkAt(0);
  EXPECT_EQ(at_zero.back()->floor_z, 0);
  for (const double z : {0.06, -0.30}) {
    const auto lifted = WalkAt(z);
    ASSERT_EQ(lifted.size(), at_zero.size());
    EXPECT_NEAR(lifted.back()->floor_z, z, 0.005);
    for (std::size_t i = 0; i < lifted.size(); ++i) {
      const PersonState& a = at_zero[i]->people.at(0);
      const PersonState& b = lifted[i]->people.at(0);
      for (std::size_t j = 0; j < a.loads.size(); ++j) {
        ASSERT_EQ(a.loads[j].reason, b.loads[j].reason) << "at " << i << ", " << z << " m higher";
        ASSERT_NEAR(a.loads[j].ratio, b.loads[j].ratio, 0.01) << "at " << i;
      }
    }
  }
  EXPECT_EQ(WalkAt(0.06, 0.055).back()->floor_z, 0.055) << "as it was given";
}

TEST(SceneBuilder, TakesTheLengthsFromThePosesUntilTheSourceSendsThem) {
  Built built;
  const auto motion = subject::MakeMotion("walk", 1.6);
  BodySample sample = motion->At(0.5);
  sample.stamp_nanos = 1;
  built.builder.OnSample(sample);
  const auto shank_of = [](const urdf::Skeleton& skeleton) {
    return skeleton.origin_in_parent[urdf::kRightFoot].norm();
  };
  const PersonModel& measured = *built.last().people.at(0).model;
  EXPECT_TRUE(measured.lengths_are_measured && measured.lengths_are_of_poses);
  EXPECT_NEAR(shank_of(measured.human.skeleton), shank_of(urdf::DefaultSkeleton(1.6)), 1e-6);
  Character named;
  named.name = "Anna";
  built.builder.OnCharacter(named);  // without lengths
  sample.stamp_nanos += 10'000'000;
  built.builder.OnSample(sample);
  EXPECT_TRUE(built.last().people.at(0).model->lengths_are_of_poses);
  named.skeleton = motion->character().skeleton;
  built.builder.OnCharacter(named);
  sample.stamp_nanos += 10'000'000;
  built.builder.OnSample(sample);
  const PersonModel& sent = *built.last().people.at(0).model;
  EXPECT_TRUE(sent.lengths_are_measured);
  EXPECT_FALSE(sent.lengths_are_of_poses);
}

TEST(SceneBuilder, SaysThatSegmentsHaveOtherLengthsWithoutNewScaleData) {
  const kinescope::testing::CapturedLog log;
  Built built;
  const auto anna = subject::MakeMotion("walk", 1.6), ben = subject::MakeMotion("walk", 1.9);
  Character named;
  named.name = "Anna";
  named.skeleton = anna->character().skeleton;
  built.builder.OnCharacter(named);
  std::int64_t stamp = 0;
  const auto feed = [&](const subject::Motion& motion, double secs) {
    for (double at = 0; at < secs; at += 0.02) {
      BodySample sample = motion.At(at);
      sample.stamp_nanos = stamp += 20'000'000;
      built.builder.OnSample(sample);
    }
  };
  feed(*anna, 3);
  EXPECT_EQ(log.text(), "");
  feed(*ben, 3);
  EXPECT_THAT(log.text(), HasSubstr("the segments of 'Anna' have other lengths now, by up to "));
}

TEST(SceneBuilder, WritesNoFiles) {
  const testing::TempFolder folder;
  setenv("XDG_CACHE_HOME", folder.path().c_str(), 1);
  SceneOptions options;
  options.mesh_cache = std::make_shared<const MeshCache>(folder.path());
  Built built(options);
  for (int i = 0; i < 3; ++i) {
    Character person;
    person.skeleton = urdf::DefaultSkeleton(1.6 + 0.1 * i);
    built.builder.OnCharacter(person);
    built.builder.OnSample(SampleOf("n_pose", 0.1 * i));
  }
  unsetenv("XDG_CACHE_HOME");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  const PersonState& person = built.last().people.at(0);
  EXPECT_TRUE(person.model->mesh_files->Provide());
  EXPECT_EQ(folder.Names().size(), 1U) << "only of the body that is shown";
}

double RatioOf(const SceneState& state, int joint) {
  for (const JointLoad& load : state.people.at(0).loads) {
    if (load.joint == joint) return load.ratio;
  }
  return std::nan("");
}

TEST(SceneBuilder, AppliesHandLoadsAndAddedMassesToTheJoints) {
  SceneOptions options;
  Built bare(options), held(options);
  loads::LoadSettings settings;
  settings.hands.is_known = true;
  settings.hands.mass_kg = {10, 0};
  held.builder.SetLoads(settings);
  options.body.added_masses = {{urdf::kT8, 20, {-0.2, 0, 0.1}}};
  Built laden(options);
  const BodySample sample = SampleOf("t_pose", 0);
  for (Built* built : {&bare, &held, &laden}) built->builder.OnSample(sample);
  EXPECT_GT(RatioOf(held.last(), urdf::jRightShoulder),
            RatioOf(bare.last(), urdf::jRightShoulder) + 0.5);
  EXPECT_EQ(RatioOf(held.last(), urdf::jLeftShoulder), RatioOf(bare.last(), urdf::jLeftShoulder));
  EXPECT_GT(RatioOf(laden.last(), urdf::jL5S1), RatioOf(bare.last(), urdf::jL5S1) + 0.05);
  EXPECT_NEAR(laden.last().people.at(0).forces.body_mass_kg, 95, 1e-9);
  EXPECT_FALSE(laden.last().people.at(0).forces.com_minus_mvn) << "MVN knows of no backpack";
  EXPECT_TRUE(bare.last().people.at(0).forces.body_mass_is_assumed);
}

TEST(SceneBuilder, UsesTheStrengthOfWomenForAWoman) {
  SceneOptions options;
  options.body.sex = urdf::Sex::kFemale;
  Built woman(options), man;
  const BodySample sample = SampleOf("t_pose", 0);
  woman.builder.OnSample(sample);
  man.builder.OnSample(sample);
  const auto capacity = [](const Built& built) {
    return built.last().people.at(0).loads.at(3).capacity;  // shoulder
  };
  EXPECT_NEAR(capacity(woman), capacity(man) / 2, 1e-9);
}

TEST(SceneBuilder, AppliesValidMeasuredForcesToTheirPersonOnly) {
  Built built;
  BodySample sample = SampleOf("n_pose", 0);
  loads::Measurements measured;
  measured.ground.emplace().force = {0, 0, 735.75};
  measured.ground->point = {0.05, 0, 0};
  measured.ground->stamp_nanos = sample.stamp_nanos;
  built.builder.SetMeasurements(1, measured);
  built.builder.OnSample(sample);
  EXPECT_FALSE(built.last().people.at(0).forces.ground_is_measured) << "another person's plate";
  built.builder.SetMeasurements(0, measured);
  sample.stamp_nanos += 10'000'000;
  built.builder.OnSample(sample);
  EXPECT_TRUE(built.last().people.at(0).forces.ground_is_measured);
  EXPECT_NEAR(built.last().people.at(0).cop->x(), 0.05, 1e-12);
  sample.stamp_nanos += 600'000'000;
  built.builder.OnSample(sample);
  EXPECT_FALSE(built.last().people.at(0).forces.ground_is_measured);
}

// Samples of 100 Hz that arrive every `arrival_step_nanos`.
void SendSamples(int count, std::int64_t arrival_step_nanos, BodySample& sample, Built& built) {
  for (int i = 0; i < count; ++i) {
    sample.arrival_nanos += arrival_step_nanos;
    sample.stamp_nanos += 10'000'000;
    built.builder.OnSample(sample);
  }
}

TEST(SceneBuilder, MeasuresTheRateOfALiveStream) {
  Built built;
  BodySample sample = SampleOf("n_pose", 0);
  SendSamples(300, 10'000'000, sample, built);
  EXPECT_NEAR(built.last().rate_hz, 100, 1);
}

TEST(SceneBuilder, HasNoRateBeforeOneSecondOfSamples) {
  Built built;
  BodySample sample = SampleOf("n_pose", 0);
  // As at the start of a program: what waited in the socket comes at once, then 100 per second.
  SendSamples(10, 100'000, sample, built);
  for (int i = 0; i < 98; ++i) {
    SendSamples(1, 10'000'000, sample, built);
    ASSERT_EQ(built.last().rate_hz, 0) << "after " << i + 1 << " samples";
  }
  SendSamples(300, 10'000'000, sample, built);
  EXPECT_NEAR(built.last().rate_hz, 100, 1);
}

TEST(SceneBuilder, ReportsTheRateOfOnePersonForSeveralPeople) {
  Built built;
  BodySample sample = SampleOf("n_pose", 0);
  for (int i = 0; i < 300; ++i) {
    sample.arrival_nanos += 10'000'000;
    sample.stamp_nanos += 10'000'000;
    for (sample.character = 0; sample.character < 3; ++sample.character) {
      built.builder.OnSample(sample);
    }
  }
  EXPECT_NEAR(built.last().rate_hz, 100, 1);
}

TEST(SceneBuilder, ComputesTheRateOfACaptureFromItsTimeStamps) {
  Built built;
  BodySample sample = SampleOf("n_pose", 0);
  sample.arrival_nanos = 0;
  for (int i = 0; i < 300; ++i) {
    sample.stamp_nanos += 10'000'000;
    built.builder.OnSample(sample);
  }
  EXPECT_NEAR(built.last().rate_hz, 100, 1);
}

TEST(SceneBuilder, AcceptsAPersonWithoutSamples) {
  Built built;
  built.builder.OnCharacter({0, "Anna", {}, {}, {}, {}});
  BodySample sample = SampleOf("n_pose", 0);
  sample.character = 1;
  built.builder.OnSample(sample);
  ASSERT_EQ(built.last().people.size(), 1U);
  EXPECT_EQ(built.last().floor_z, 0);
}

// Each from a computer of its own, whose clocks differ.
TEST(SceneBuilder, ShowsPeopleTogetherWhoCameAtTheSameTimeWhateverTheirStampsAre) {
  Built built;
  BodySample sample = SampleOf("n_pose", 1000);
  const std::int64_t begin = sample.arrival_nanos;
  for (int i = 0; i < 200; ++i) {
    sample.arrival_nanos = begin + i * 10'000'000;
    for (const int character : {0, 1}) {
      if (character == 1 && i >= 50) continue;
      sample.character = character;
      sample.stamp_nanos = sample.arrival_nanos - character * 300'000'000'000;
      built.builder.OnSample(sample);
    }
    const bool has_second = i < 150;  // for a second after its last sample
    ASSERT_EQ(built.last().people.size(), has_second ? 2U : 1U) << i;
  }
}

TEST(SceneBuilder, ShowsTrackedObjectsByTheirNamesUntilTheyLeave) {
  Built built;
  built.builder.OnCharacter({7, "Things", {}, {}, {}, {{"HTC Vive Tracker", {0, 0, 1}}}});
  ObjectsSample objects;
  objects.character = 7;
  objects.present.set(0).set(1);
  objects.poses[1].position = {1, 2, 3};
  BodySample sample = SampleOf("n_pose", 0);
  objects.stamp_nanos = sample.stamp_nanos;
  objects.arrival_nanos = sample.arrival_nanos;
  built.builder.OnObjects(objects);
  built.builder.OnSample(sample);
  ASSERT_EQ(built.last().people.size(), 1U);
  ASSERT_EQ(built.last().objects.size(), 2U);
  EXPECT_EQ(built.last().objects[0].name, "HTC Vive Tracker");
  EXPECT_EQ(built.last().objects[1].name, "object_2");
  EXPECT_EQ(built.last().objects[1].pose.position, Vector3d(1, 2, 3));
  sample.arrival_nanos += 1'100'000'000;
  built.builder.OnSample(sample);
  EXPECT_TRUE(built.last().objects.empty());
}

}  // namespace
}  // namespace kinescope::app
