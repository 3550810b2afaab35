// The human as a mechanism, on everything that was ever recorded: the URDF's rigid body, bent by
// the published angles, is where MVN measured the person.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "core/skeleton_watch.h"
#include "server/app/stream/synthetic_gloves.h"
#include "server/http/api.h"
#include "server/mvn/datagram.h"
#include "server/ros/bridge.h"
#include "server/scene/scene_builder.h"
#include "server/scene/scene_reader.h"
#include "server/subject/subject.h"
#include "tests/shared_data.h"
#include "tests/system/run_program.h"
#include "tests/temp_folder.h"
#include "urdf/joint_limits.h"
#include "urdf/robot/robot_kinematics.h"

namespace kinescope {
namespace {

using Eigen::Isometry3d;
using testing::SharedData;
using urdf::At;

constexpr double kMaxMillimetres = 5;
constexpr double kMaxMillimetresOfL5 = 15;  // MVN interpolates it between pelvis and T8
constexpr double kMaxRadians = 1e-6;

// Chains the URDF's text by the published angles from the measured pelvis, and keeps the worst.
class Judge {
 public:
  void Look(const PersonState& person) {
    if (model_ != person.model) {
      model_ = person.model;
      robot_ = urdf::ParseUrdf(model_->urdf_xml);
      place_.clear();
      for (std::size_t i = 0; i < robot_.links.size(); ++i) place_[robot_.links[i].name] = i;
    }
    const std::string& name = model_->human.model_name;
    urdf::JointPositions positions;
    for (int joint = 0; joint < urdf::kJointCount; ++joint) {
      for (int axis = 0; axis < 3; ++axis) {
        positions[urdf::JointName(name, joint, axis)] = person.angles[At(joint)][axis];
      }
    }
    const urdf::Pose& pelvis = person.links[urdf::kPelvis];
    Isometry3d root = Isometry3d::Identity();
    root.translate(pelvis.position).rotate(pelvis.orientation);
    const auto chained = urdf::PlaceLinks(robot_, positions, root);
    for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
      const urdf::Pose& measured = person.links[At(segment)];
      const Isometry3d& rigid = chained[place_.at(urdf::LinkName(name, segment))];
      const double off = (rigid.translation() - measured.position).norm();
      // From the sine: the cosine of an angle this small is 1.
      const Eigen::Quaterniond turn =
          Eigen::Quaterniond(rigid.linear()) * measured.orientation.conjugate();
      const double turned = 2 * std::asin(std::min(1.0, turn.vec().norm()));
      EXPECT_NEAR(off, person.deviation.position[At(segment)], 1e-9)
          << "the reported deviation is not the real one at " << Name(segment);
      EXPECT_GE(person.worst_deviation.position[At(segment)],
                person.deviation.position[At(segment)]);
      worst_.position[At(segment)] = std::max(worst_.position[At(segment)], off);
      worst_.orientation[At(segment)] = std::max(worst_.orientation[At(segment)], turned);
    }
    for (int joint = 0; joint < urdf::kJointCount; ++joint) {
      for (int axis = 0; axis < 3; ++axis) {
        const urdf::AxisLimit limit = urdf::LimitOf(joint, axis);
        const double angle = person.angles[At(joint)][axis];
        if (angle < limit.lower || angle > limit.upper) {
          double& farthest = outside_[urdf::JointName(name, joint, axis)];
          if (std::abs(angle) > std::abs(farthest)) farthest = angle;
        }
      }
    }
    last_reported_ = person.worst_deviation;
    ++frames_;
  }

  static std::string_view Name(int segment) { return urdf::kSegments[At(segment)].mvn_name; }

  // `limit_mm`, by segment.
  void Expect(const std::function<double(int)>& limit_mm) const {
    EXPECT_GT(frames_, 0);
    std::string table = fmt::format("{} frames, worst by segment in mm:", frames_);
    for (int segment = 1; segment < urdf::kSegmentCount; ++segment) {
      const double millimetres = 1e3 * worst_.position[At(segment)];
      table += fmt::format(" {} {:.2f}", Name(segment), millimetres);
      EXPECT_LE(millimetres, limit_mm(segment)) << Name(segment);
      EXPECT_LT(worst_.orientation[At(segment)], kMaxRadians) << Name(segment);
      EXPECT_NEAR(last_reported_.position[At(segment)], worst_.position[At(segment)], 1e-9);
    }
    fmt::print("{}; orientation {:.1e} rad\n", table, worst_.LargestOrientation());
    for (const auto& [joint, farthest] : outside_) {
      ADD_FAILURE() << joint << " is outside the limits of the URDF, at " << farthest << " rad";
    }
  }

 private:
  std::shared_ptr<const PersonModel> model_;
  urdf::RobotModel robot_;
  std::map<std::string, std::size_t> place_;
  urdf::RigidDeviation worst_, last_reported_;
  std::map<std::string, double> outside_;
  int frames_ = 0;
};

double AsAgreed(int segment) {
  return segment == urdf::kL5 ? kMaxMillimetresOfL5 : kMaxMillimetres;
}

Judge ReadAll(const std::string& source, int most_frames) {
  app::SceneOptions options;
  app::SceneReader reader(source, options);
  Judge judge;
  for (int frame = 0; frame < most_frames; ++frame) {
    const auto state = reader.Next();
    if (!state) break;
    for (const PersonState& person : state->people) judge.Look(person);
  }
  return judge;
}

constexpr int kAll = 1'000'000;

TEST(Mechanism, MatchesEverySampleOfTheBuiltInSubjects) {
  for (const std::string& motion : subject::MotionNames()) {
    SCOPED_TRACE(motion);
    constexpr int kTenSeconds = 600;  // longer than any motion's period
    ReadAll("demo:" + motion, kTenSeconds).Expect([](int) { return 1e-6; });
  }
}

TEST(Mechanism, MatchesEverySampleOfAFullBodyRecordingWithinMillimetres) {
  KINESCOPE_NEEDS_SHARED_DATA("mvnx/Meri-020.mvnx");
  ReadAll(SharedData("mvnx/Meri-020.mvnx"), kAll).Expect(AsAgreed);
}

TEST(Mechanism, MatchesEverySampleOfAnUpperBodyRecordingWithinMillimetres) {
  KINESCOPE_NEEDS_SHARED_DATA("mvnx/test_mocap.mvnx");
  ReadAll(SharedData("mvnx/test_mocap.mvnx"), kAll).Expect(AsAgreed);
}

TEST(Mechanism, MatchesEverySampleOfABagWithinMillimetres) {
  if (!ros_bridge::BuiltWithRos()) GTEST_SKIP() << "bags need ROS";
  KINESCOPE_NEEDS_SHARED_DATA("ros1/2018-05-28-17-34-45.bag.xz");
  ReadAll(SharedData("ros1/2018-05-28-17-34-45.bag.xz"), kAll).Expect(AsAgreed);
}

// A sheet of MVN's Excel export: a row for each frame, whose number comes first.
std::vector<std::vector<double>> ReadSheet(const std::string& file) {
  std::ifstream sheet(SharedData(file));
  std::vector<std::vector<double>> rows;
  std::string line;
  std::getline(sheet, line);  // names
  while (std::getline(sheet, line)) {
    std::vector<double>& row = rows.emplace_back();
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) row.push_back(std::stod(field));
  }
  return rows;
}

// It has no scale data: the lengths are those of its first frame, as for a person on TF.
TEST(Mechanism, MatchesEverySampleOfAnExcelExportWithinMillimetres) {
  KINESCOPE_NEEDS_SHARED_DATA("excel-export-P005/segment_position.csv");
  KINESCOPE_NEEDS_SHARED_DATA("excel-export-P005/segment_orientation_quat.csv");
  const auto positions = ReadSheet("excel-export-P005/segment_position.csv");
  const auto turns = ReadSheet("excel-export-P005/segment_orientation_quat.csv");
  ASSERT_EQ(positions.size(), 103U);
  ASSERT_EQ(turns.size(), positions.size());
  std::shared_ptr<const SceneState> state;
  app::SceneOptions options;
  app::SceneBuilder builder(options, "", 60, [&](const auto& newest) { state = newest; });
  SkeletonWatch lengths;
  Judge judge;
  for (std::size_t frame = 0; frame < positions.size(); ++frame) {
    const std::vector<double>& p = positions[frame];
    const std::vector<double>& q = turns[frame];
    ASSERT_EQ(p.size(), 1U + 3 * urdf::kSegmentCount);
    ASSERT_EQ(q.size(), 1U + 4 * urdf::kSegmentCount);
    BodySample sample;
    sample.counter = static_cast<std::uint32_t>(frame);
    sample.stamp_nanos = 1 + static_cast<std::int64_t>(frame) * 1'000'000'000 / 60;
    for (std::size_t i = 0; i < urdf::kSegmentCount; ++i) {
      sample.segments[i].position = {p[1 + 3 * i], p[2 + 3 * i], p[3 + 3 * i]};
      sample.segments[i].orientation =
          Eigen::Quaterniond(q[1 + 4 * i], q[2 + 4 * i], q[3 + 4 * i], q[4 + 4 * i]).normalized();
    }
    if (auto skeleton = lengths.Look(sample)) {
      EXPECT_EQ(frame, 0U) << "the person is the same all the time";
      Character character;
      character.skeleton = std::move(skeleton);
      builder.OnCharacter(character);
    }
    builder.OnSample(sample);
    judge.Look(state->people.at(0));
  }
  judge.Expect(AsAgreed);
}

TEST(Mechanism, MatchesARecordedDatagramWithItsScaleDataWithinMillimetres) {
  KINESCOPE_NEEDS_SHARED_DATA("udp/mxtp13.bin");
  const auto scale_message = mvn::ParseDatagram(testing::ReadFile(SharedData("udp/mxtp13.bin")));
  const auto pose_message = mvn::ParseDatagram(testing::ReadFile(SharedData("udp/mxtp02.bin")));
  ASSERT_TRUE(scale_message && pose_message);
  const auto& scale = std::get<mvn::ScaleMessage>(scale_message->body);
  const auto& pose = std::get<mvn::PoseMessage>(pose_message->body);
  ASSERT_EQ(scale.segments.size(), std::size_t{urdf::kSegmentCount});
  std::array<Eigen::Vector3d, urdf::kSegmentCount> t_pose;
  BodySample sample;
  for (std::size_t i = 0; i < t_pose.size(); ++i) {
    t_pose[i] = scale.segments[i].origin_in_world;
    sample.segments[i].position = pose.items[i].position;
    sample.segments[i].orientation = pose.items[i].orientation;
  }
  std::shared_ptr<const SceneState> state;
  app::SceneOptions options;
  app::SceneBuilder builder(options, "", 0, [&](const auto& newest) { state = newest; });
  Character character;
  character.skeleton = urdf::SkeletonFromTPose(t_pose, {});
  builder.OnCharacter(character);
  builder.OnSample(sample);
  Judge judge;
  judge.Look(state->people.at(0));
  judge.Expect(AsAgreed);
}

TEST(Mechanism, ReportsItsDeviationByJointOverHttp) {
  const double kStretched = 0.004;  // m
  app::SceneOptions options;
  std::shared_ptr<const SceneState> state;
  app::SceneBuilder builder(options, "", 0, [&](const auto& newest) { state = newest; });
  const auto motion = subject::MakeMotion("lift");
  builder.OnCharacter(motion->character());
  BodySample sample = motion->At(0);
  sample.segments[urdf::kLeftHand].position.x() += kStretched;
  builder.OnSample(sample);
  builder.OnSample(motion->At(0.1));
  const auto told = nlohmann::json::parse(http::StateJson(state.get(), 0));
  const auto& joints = told.at("people").at(0).at("deviation_mm");
  ASSERT_EQ(joints.size(), std::size_t{urdf::kJointCount});
  for (const auto& [name, deviation] : joints.items()) {
    EXPECT_NEAR(deviation.at("now").get<double>(), 0, 1e-3) << name;
    EXPECT_NEAR(deviation.at("max").get<double>(), name == "left_wrist" ? 1e3 * kStretched : 0,
                1e-3)
        << name;
  }
  // Another body is another URDF: what the old one was off does not count.
  Character taller = motion->character();
  taller.skeleton = urdf::DefaultSkeleton(1.9);
  builder.OnCharacter(taller);
  const auto tall = subject::MakeMotion("lift", 1.9);
  builder.OnSample(tall->At(0.2));
  EXPECT_LT(state->people.at(0).worst_deviation.LargestPosition(), 1e-9);
}

// The newest state of a gloved person after `samples`, with everything that was described.
class GlovedPerson {
 public:
  explicit GlovedPerson(const Character& character)
      : builder_(Options(), "", 0, [this](const auto& newest) { state_ = newest; }),
        character_(character) {
    builder_.OnCharacter(character);
  }
  PersonState See(double seconds, const std::function<void(BodySample&)>& change = {}) {
    BodySample sample = motion_->At(seconds);
    app::AddGlovesAndProps(true, 1, seconds, character_, sample);
    if (change) change(sample);
    builder_.OnSample(sample);
    return state_->people.at(0);
  }

 private:
  static app::SceneOptions Options() {
    app::SceneOptions options;
    return options;
  }
  const std::unique_ptr<subject::Motion> motion_ = subject::MakeMotion("lift");
  std::shared_ptr<const SceneState> state_;
  app::SceneBuilder builder_;
  Character character_;
};

Character Described(bool with_fingers) {
  Character character = subject::MakeMotion("lift")->character();
  if (with_fingers) app::AddGlovesAndProps(true, 1, character);
  return character;
}

// Farthest that a finger's joint is from where its parent and the URDF's length put it, m.
double WorstFinger(const PersonState& person) {
  double worst = 0;
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    const urdf::HandSkeleton& hand = *person.model->human.gloves[side];
    const GloveState& glove = *person.gloves[side];
    for (std::size_t i = 0; i < glove.links.size(); ++i) {
      const int above = kFingerParents[i];
      const urdf::Pose& parent =
          above < 0 ? person.links[At(urdf::HandSegmentOf(side))] : glove.links[At(above)];
      const Eigen::Vector3d rigid = parent.position + parent.orientation * hand.origin_in_parent[i];
      worst = std::max(worst, (rigid - glove.links[i].position).norm());
    }
  }
  return worst;
}

TEST(Mechanism, GetsHandsWithLengthsOfTheScaleDataWhenTheyAreStreamed) {
  GlovedPerson person(Described(true));
  const PersonState bare =
      person.See(0, [](BodySample& sample) { sample.fingers_and_props.present.reset(); });
  EXPECT_EQ(bare.model->urdf_xml.find("carpus"), std::string::npos);
  EXPECT_FALSE(bare.gloves[urdf::kLeft]);
  for (int frame = 1; frame < 300; ++frame) {
    const PersonState& gloved = person.See(frame / 60.0);
    ASSERT_TRUE(gloved.gloves[urdf::kLeft] && gloved.gloves[urdf::kRight] && gloved.props[0]);
    EXPECT_GT(gloved.model->revision, bare.model->revision);
    EXPECT_LT(WorstFinger(gloved), 1e-6) << "frame " << frame;
  }
  EXPECT_NE(person.See(6).model->urdf_xml.find("skeleton_left_carpus"), std::string::npos);
  EXPECT_EQ(person.See(7).model, person.See(8).model) << "the URDF changes once";
}

TEST(Mechanism, GetsAverageHandsIfTheirLengthsAreUnknown) {
  GlovedPerson person(Described(false));
  const double worst = WorstFinger(person.See(1));
  EXPECT_LT(worst, 0.01) << "the streamed hand is an average one";
  const auto& hand = person.See(2).model->human.gloves[urdf::kRight];
  ASSERT_TRUE(hand);
  EXPECT_NEAR(hand->length, urdf::DefaultSkeleton().finger_tip_in_hand[urdf::kRight].norm(), 1e-9);
}

TEST(Mechanism, KeepsTheLastFingerAnglesWhileFingersAreNotStreamed) {
  GlovedPerson person(Described(true));
  const PersonState with = person.See(1.0);
  const PersonState without =
      person.See(1.5, [](BodySample& sample) { sample.fingers_and_props.present.reset(); });
  EXPECT_EQ(with.model, without.model);
  for (std::size_t i = 0; i < kFingersPerHand; ++i) {
    EXPECT_EQ(without.gloves[urdf::kLeft]->angles[i], with.gloves[urdf::kLeft]->angles[i]);
  }
  EXPECT_LT(WorstFinger(without), 1e-9);
  const auto in_pelvis = [](const PersonState& state) {
    const urdf::Pose& pelvis = state.links[urdf::kPelvis];
    return Eigen::Vector3d(pelvis.orientation.conjugate() *
                           (state.props[0]->pose.position - pelvis.position));
  };
  EXPECT_LT((in_pelvis(with) - in_pelvis(without)).norm(), 1e-12);
}

// The tool that comes with urdfdom, which people run on a URDF before anything else.
TEST(Mechanism, IsAcceptedByCheckUrdf) {
  const testing::TempFolder folder;
  urdf::HumanModel human;
  human.skeleton = urdf::DefaultSkeleton();
  human.body = urdf::MakeBodyParameters({}, human.skeleton);
  for (const bool with_gloves : {false, true}) {
    if (with_gloves) {
      human.gloves = {urdf::DefaultHand(urdf::kRight, 0.19), urdf::DefaultHand(urdf::kLeft, 0.19)};
      human.props.set();
    }
    const std::string path = folder / "person.urdf";
    std::ofstream(path) << urdf::WriteUrdf(human);
    const auto checked = testing::RunProgram({KINESCOPE_CHECK_URDF, path});
    EXPECT_EQ(checked.exit_code, 0) << checked.err;
    EXPECT_EQ(checked.err, "");
    EXPECT_NE(checked.out.find("Successfully Parsed XML"), std::string::npos) << checked.out;
    EXPECT_NE(checked.out.find("skeleton_right_toe"), std::string::npos) << checked.out;
  }
}

}  // namespace
}  // namespace kinescope
