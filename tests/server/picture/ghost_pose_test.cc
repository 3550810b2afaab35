// The second body of a picture: the forms of --ghost, and where it stands.
#include "server/picture/ghost_pose.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "server/scene/scene_reader.h"
#include "tests/render/test_scene.h"
#include "tests/worn.h"

namespace kinescope::app {
namespace {

using Eigen::Vector3d;
using ::testing::IsEmpty;
using ::testing::SizeIs;

SceneState BentScene() {
  SceneState scene = testing::SceneWith(testing::Posture::kDeepBend, LoadClass::kLow, 2, -1);
  scene.floor_z = 0.25;
  return scene;
}

std::vector<Ghost> GhostsOf(const std::string& text, double opacity, const SceneState& scene) {
  GhostValue ghost;
  ghost.Parse(text);
  return GhostPose(ghost, opacity, {}).Make(scene);
}

double LowestOfFeet(const PersonState& person) {
  const urdf::Skeleton& skeleton = person.model->human.skeleton;
  double lowest = 1e9;
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    const urdf::Pose& foot = person.links[urdf::At(urdf::FootSegmentOf(side))];
    const urdf::Pose& toe = person.links[urdf::At(urdf::FootSegmentOf(side) + 1)];
    lowest = std::min({lowest, (foot.position + foot.orientation * skeleton.heel_in_foot[side]).z(),
                       (toe.position + toe.orientation * skeleton.toe_tip_in_toe[side]).z()});
  }
  return lowest;
}

TEST(GhostPose, IsAbsentByDefault) { EXPECT_THAT(GhostsOf("", 0.5, BentScene()), IsEmpty()); }

TEST(GhostPose, StandsUprightOnTheFloorBelowThePelvis) {
  const SceneState scene = BentScene();
  for (const char* pose : {"n_pose", "t_pose"}) {
    const auto ghosts = GhostsOf(pose, 0.35, scene);
    ASSERT_THAT(ghosts, SizeIs(1)) << pose;
    EXPECT_EQ(ghosts[0].opacity, 0.35);
    const PersonState& ghost = ghosts[0].person;
    EXPECT_NEAR(LowestOfFeet(ghost), scene.floor_z, 1e-9) << pose;
    EXPECT_EQ(ghost.links[urdf::kPelvis].position.head<2>(),
              scene.people[0].links[urdf::kPelvis].position.head<2>());
    EXPECT_GT(ghost.links[urdf::kHead].position.z() - scene.floor_z, 1.4) << "upright";
    EXPECT_EQ(ghost.model, scene.people[0].model) << "with the person's own lengths";
  }
}

TEST(GhostPose, HasArmsDownInTheNPoseAndSidewaysInTheTPose) {
  const auto hand_from_shoulder = [](const char* pose, int hand, int upper_arm) -> Vector3d {
    const PersonState ghost = GhostsOf(pose, 1, BentScene()).at(0).person;
    return ghost.links[urdf::At(hand)].position - ghost.links[urdf::At(upper_arm)].position;
  };
  const Vector3d hanging =
      hand_from_shoulder("n_pose", urdf::kRightHand, urdf::kRightUpperArm).normalized();
  EXPECT_LT(hanging.z(), -0.99);
  const Vector3d right =
      hand_from_shoulder("t_pose", urdf::kRightHand, urdf::kRightUpperArm).normalized();
  const Vector3d left =
      hand_from_shoulder("t_pose", urdf::kLeftHand, urdf::kLeftUpperArm).normalized();
  EXPECT_LT(right.y(), -0.99) << "facing x, the right is at -y";
  EXPECT_GT(left.y(), 0.99);
}

TEST(GhostPose, HasTheHeadingOfThePerson) {
  SceneState scene = BentScene();
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(2, Vector3d::UnitZ()));
  for (urdf::Pose& link : scene.people[0].links) {
    link.position = turn * link.position;
    link.orientation = turn * link.orientation;
  }
  const PersonState ghost = GhostsOf("n_pose", 1, scene).at(0).person;
  const Vector3d ahead = ghost.links[urdf::kPelvis].orientation * Vector3d::UnitX();
  EXPECT_NEAR((ahead - turn * Vector3d::UnitX()).norm(), 0, 1e-9);
}

TEST(GhostPose, IncludesGlovesAndProps) {
  SceneState scene = BentScene();
  testing::Wear(scene.people[0]);
  const PersonState& person = scene.people[0];
  const PersonState ghost = GhostsOf("n_pose", 1, scene).at(0).person;
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    const std::size_t hand = urdf::At(urdf::HandSegmentOf(side));
    ASSERT_TRUE(ghost.gloves[side]);
    for (std::size_t i = 0; i < ghost.gloves[side]->links.size(); ++i) {
      const urdf::Pose before = urdf::Relative(person.links[hand], person.gloves[side]->links[i]);
      const urdf::Pose after = urdf::Relative(ghost.links[hand], ghost.gloves[side]->links[i]);
      EXPECT_NEAR((before.position - after.position).norm(), 0, 1e-9);
      EXPECT_NEAR(before.orientation.angularDistance(after.orientation), 0, 1e-6);
    }
  }
}

TEST(GhostPose, ExistsForEveryPerson) {
  SceneState scene = BentScene();
  scene.people.push_back(scene.people[0]);
  EXPECT_THAT(GhostsOf("t_pose", 1, scene), SizeIs(2));
  scene.people.clear();
  EXPECT_THAT(GhostsOf("t_pose", 1, scene), IsEmpty());
}

TEST(GhostPose, ShowsTheGivenTimeOfARecording) {
  SceneReader reader("demo:lift", {});
  SceneTimeline timeline(reader);
  const auto then = timeline.At(0.5);
  ASSERT_TRUE(then);
  const auto ghosts = GhostsOf("demo:lift@0.5", 0.2, BentScene());
  ASSERT_THAT(ghosts, SizeIs(1));
  EXPECT_EQ(ghosts[0].opacity, 0.2);
  for (std::size_t i = 0; i < then->people[0].links.size(); ++i) {
    EXPECT_EQ(ghosts[0].person.links[i].position, then->people[0].links[i].position);
  }
  EXPECT_THAT(GhostsOf("demo:lift@0", 1, BentScene()), SizeIs(1)) << "the very beginning";
}

}  // namespace
}  // namespace kinescope::app
