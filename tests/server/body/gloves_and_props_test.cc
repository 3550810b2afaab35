// Gloves and props from sample to sample: once seen they stay, and where nothing is measured they
// go along.
#include "server/body/gloves_and_props.h"

#include <gtest/gtest.h>

#include "urdf/hand.h"

namespace kinescope::app {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using urdf::At;

urdf::Pose TurnedPoseAt(const Vector3d& position, double turn_rad = 0) {
  return {position, Quaterniond(Eigen::AngleAxisd(turn_rad, Vector3d::UnitZ()))};
}

// A sample whose hands are at y = -0.3 and 0.3, with the pelvis at `pelvis`.
BodySample BareSample(const urdf::Pose& pelvis = TurnedPoseAt({0, 0, 1})) {
  BodySample sample;
  sample.segments[urdf::kPelvis].position = pelvis.position;
  sample.segments[urdf::kPelvis].orientation = pelvis.orientation;
  sample.segments[urdf::kRightHand].position = Vector3d(0, -0.3, 0.8);
  sample.segments[urdf::kLeftHand].position = Vector3d(0, 0.3, 0.8);
  return sample;
}

void ShowExtra(BodySample& sample, int index, const urdf::Pose& pose) {
  sample.fingers_and_props.poses[At(index)] = pose;
  sample.fingers_and_props.present.set(At(index));
}

// The person of `sample`, with the model that the extras make.
PersonState PersonWith(const GlovesAndProps& extras, const BodySample& sample) {
  auto model = std::make_shared<PersonModel>();
  model->human.skeleton = urdf::DefaultSkeleton();
  extras.AddTo({}, model->human);
  PersonState person;
  person.model = model;
  person.links = LinkPosesOf(sample);
  return person;
}

TEST(GlovesAndProps, AreDetectedOnce) {
  GlovesAndProps extras;
  BodySample sample = BareSample();
  EXPECT_FALSE(extras.Notice(sample));
  ShowExtra(sample, PropIndex(2), TurnedPoseAt({1, 0, 1}));
  EXPECT_TRUE(extras.Notice(sample));
  EXPECT_FALSE(extras.Notice(sample));
  ShowExtra(sample, FingerIndex(urdf::kLeft, 0), TurnedPoseAt({0, 0.3, 0.8}));
  EXPECT_TRUE(extras.Notice(sample));
  EXPECT_FALSE(extras.Notice(sample));
  EXPECT_FALSE(extras.Notice(BareSample())) << "they stay, whatever a sample lacks";
}

TEST(GlovesAndProps, AreAddedToTheModelWhenDetected) {
  GlovesAndProps extras;
  BodySample sample = BareSample();
  ShowExtra(sample, PropIndex(0), TurnedPoseAt({1, 0, 1}));
  ShowExtra(sample, PropIndex(3), TurnedPoseAt({1, 0, 1}));
  ShowExtra(sample, FingerIndex(urdf::kRight, 0), TurnedPoseAt({0, -0.3, 0.8}));
  EXPECT_TRUE(extras.Notice(sample));
  urdf::HumanModel human;
  human.skeleton = urdf::DefaultSkeleton();
  extras.AddTo({}, human);
  EXPECT_EQ(human.props.to_ulong(), 0b1001U);
  EXPECT_TRUE(human.gloves[urdf::kRight]);
  EXPECT_FALSE(human.gloves[urdf::kLeft]);
}

// The carpus of a glove is where the first sample has it, unless that is no part of the hand.
TEST(GlovesAndProps, PutTheCarpusAtItsFirstPositionOnTheHand) {
  for (const auto& [away, expected] : {std::pair(0.02, 0.02), std::pair(0.5, 0.0)}) {
    GlovesAndProps extras;
    BodySample sample = BareSample();
    ShowExtra(sample, FingerIndex(urdf::kRight, 0), TurnedPoseAt(Vector3d(away, -0.3, 0.8)));
    EXPECT_TRUE(extras.Notice(sample));
    urdf::HumanModel human;
    human.skeleton = urdf::DefaultSkeleton();
    extras.AddTo({}, human);
    ASSERT_TRUE(human.gloves[urdf::kRight]);
    EXPECT_NEAR(human.gloves[urdf::kRight]->origin_in_parent[0].norm(), expected, 1e-9) << away;
  }
}

TEST(GlovesAndProps, MoveAnUnmeasuredPropWithThePelvis) {
  GlovesAndProps extras;
  BodySample seen = BareSample(TurnedPoseAt({0, 0, 1}));
  ShowExtra(seen, PropIndex(1), TurnedPoseAt({0.5, 0, 1.2}));
  EXPECT_TRUE(extras.Notice(seen));
  PersonState person = PersonWith(extras, seen);
  extras.Follow(seen, person);
  ASSERT_TRUE(person.props[1]);
  EXPECT_NEAR((person.props[1]->pose.position - Vector3d(0.5, 0, 1.2)).norm(), 0, 1e-9);
  EXPECT_FALSE(person.props[0]);

  const BodySample turned =
      BareSample(TurnedPoseAt({2, 1, 1}, M_PI_2));  // nothing of the prop in it
  person.links = LinkPosesOf(turned);
  extras.Follow(turned, person);
  EXPECT_NEAR((person.props[1]->pose.position - Vector3d(2, 1.5, 1.2)).norm(), 0, 1e-9)
      << "half a metre ahead of a pelvis that looks along y";
}

TEST(GlovesAndProps, MoveUnmeasuredFingersWithTheHand) {
  GlovesAndProps extras;
  BodySample sample = BareSample();
  ShowExtra(sample, FingerIndex(urdf::kRight, 0), TurnedPoseAt({0, -0.3, 0.8}));
  EXPECT_TRUE(extras.Notice(sample));
  PersonState person = PersonWith(extras, sample);
  extras.Follow(sample, person);
  ASSERT_TRUE(person.gloves[urdf::kRight]);
  EXPECT_FALSE(person.gloves[urdf::kLeft]);
  const auto fingers_in_hand = [&] {
    std::vector<Vector3d> places;
    for (const urdf::Pose& link : person.gloves[urdf::kRight]->links) {
      places.push_back(urdf::Relative(person.links[urdf::kRightHand], link).position);
    }
    return places;
  };
  const auto before = fingers_in_hand();
  BodySample moved = BareSample();
  moved.segments[urdf::kRightHand].position += Vector3d(0.1, 0.2, 0.3);
  person.links = LinkPosesOf(moved);
  extras.Follow(moved, person);
  const auto after = fingers_in_hand();
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_NEAR((after[i] - before[i]).norm(), 0, 1e-9);

  const Vector3d measured(0.17, -0.11, 1.0);
  ShowExtra(moved, FingerIndex(urdf::kRight, 7), TurnedPoseAt(measured));
  extras.Follow(moved, person);
  EXPECT_EQ(person.gloves[urdf::kRight]->links[7].position, measured);
}

// Scale data give the fingers' lengths only where they describe the whole hand, and a hand that can
// be.
TEST(GlovesAndProps, UseLengthsOfScaleDataOnlyIfTheyDescribeAHand) {
  GlovesAndProps extras;
  BodySample sample = BareSample();
  ShowExtra(sample, FingerIndex(urdf::kRight, 0), TurnedPoseAt({0, -0.3, 0.8}));
  EXPECT_TRUE(extras.Notice(sample));
  const auto glove_of = [&](const Character& character) {
    urdf::HumanModel human;
    human.skeleton = urdf::DefaultSkeleton();
    extras.AddTo(character, human);
    return *human.gloves[urdf::kRight];
  };
  const urdf::HandSkeleton average = glove_of({});
  Character character;
  character.scaled_segments.resize(kFingerAndPropCount);
  for (int i = 0; i < kFingersPerHand; ++i) {
    ScaledSegment& segment = character.scaled_segments[At(FingerIndex(urdf::kRight, i))];
    segment.name = "finger";
    segment.origin_in_world = Vector3d(0.001 * i, -0.7 - 0.004 * i, 1.4);
  }
  EXPECT_NE(glove_of(character).origin_in_parent, average.origin_in_parent);
  Character long_boned = character;
  long_boned.scaled_segments[At(FingerIndex(urdf::kRight, 9))].origin_in_world.y() -= 0.3;
  EXPECT_EQ(glove_of(long_boned).origin_in_parent, average.origin_in_parent) << "no bone of 30 cm";
  Character with_hole = character;
  with_hole.scaled_segments[At(FingerIndex(urdf::kRight, 19))].name.clear();
  EXPECT_EQ(glove_of(with_hole).origin_in_parent, average.origin_in_parent);
}

}  // namespace
}  // namespace kinescope::app
