// Where points have been: how long it is remembered, and of whom.
#include "server/picture/trails.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "server/picture/view_options.h"
#include "tests/render/test_scene.h"
#include "tests/server/options_testing.h"

namespace kinescope::app {
namespace {

using Eigen::Vector3d;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// A person whose pelvis is at x = `secs`.
SceneState SceneOnItsWay(double secs) {
  static const SceneState standing = testing::SceneWith(testing::Posture::kStanding);
  SceneState scene = standing;
  scene.stamp_nanos = std::llround(secs * 1e9);
  const Vector3d shift(secs - scene.people[0].links[urdf::kPelvis].position.x(), 0, 0);
  for (urdf::Pose& link : scene.people[0].links) link.position += shift;
  scene.people[0].com = scene.people[0].links[urdf::kPelvis].position;
  return scene;
}

void RememberTenths(Trails& trails, int from, int to) {
  for (int i = from; i <= to; ++i) trails.Remember(SceneOnItsWay(0.1 * i));
}

TEST(Trails, HaveTheGivenLengthAndEndAtThePerson) {
  Trails trails(TrailSettings{{-1}, 1});
  RememberTenths(trails, 0, 30);
  const auto made = trails.Make();
  ASSERT_THAT(made, SizeIs(1));
  EXPECT_THAT(made[0].points, SizeIs(11)) << "from 2.0 to 3.0 s";
  EXPECT_NEAR(made[0].points.front().x(), 2, 1e-9);
  EXPECT_NEAR(made[0].points.back().x(), 3, 1e-9);
}

TEST(Trails, NeedMoreThanOnePoint) {
  Trails trails(TrailSettings{{-1}, 1});
  EXPECT_THAT(trails.Make(), IsEmpty());
  trails.Remember(SceneOnItsWay(0));
  EXPECT_THAT(trails.Make(), IsEmpty());
}

TEST(Trails, AcceptBothNamesOfASegment) {
  Trails trails(TrailSettings{
      *testing::With<ViewOptions>({{"trail", "com,RightHand,left_hand"}}).trails.points, 1});
  EXPECT_FALSE(trails.empty());
  RememberTenths(trails, 0, 3);
  const auto made = trails.Make();
  ASSERT_THAT(made, SizeIs(3));
  const SceneState last = SceneOnItsWay(0.1 * 3);
  EXPECT_EQ(made[0].points.back(), *last.people[0].com);
  EXPECT_EQ(made[1].points.back(), last.people[0].links[urdf::kRightHand].position);
  EXPECT_EQ(made[2].points.back(), last.people[0].links[urdf::kLeftHand].position);
  EXPECT_NE(made[1].color, made[2].color);
  EXPECT_NE(made[0].color, made[1].color);
}

TEST(Trails, AreAbsentWithoutNames) {
  Trails trails(TrailSettings{{}, 1});
  EXPECT_TRUE(trails.empty());
  RememberTenths(trails, 0, 3);
  EXPECT_THAT(trails.Make(), IsEmpty());
}

TEST(Trails, StartAgainAfterAGapOfTheCentreOfMass) {
  Trails trails(TrailSettings{{-1, urdf::kPelvis}, 10});
  RememberTenths(trails, 0, 5);
  SceneState without = SceneOnItsWay(0.6);
  without.people[0].com.reset();
  trails.Remember(without);
  RememberTenths(trails, 7, 9);
  const auto made = trails.Make();
  ASSERT_THAT(made, SizeIs(2));
  EXPECT_THAT(made[0].points, SizeIs(3));
  EXPECT_THAT(made[1].points, SizeIs(10)) << "the pelvis was always there";
}

TEST(Trails, AreRemovedWithThePersonAndStartAgain) {
  Trails trails(TrailSettings{{urdf::kPelvis}, 10});
  RememberTenths(trails, 0, 5);
  SceneState empty = SceneOnItsWay(0.6);
  empty.people.clear();
  trails.Remember(empty);
  EXPECT_THAT(trails.Make(), IsEmpty());
  RememberTenths(trails, 7, 8);
  ASSERT_THAT(trails.Make(), SizeIs(1));
  EXPECT_THAT(trails.Make()[0].points, SizeIs(2));
}

TEST(Trails, AreSeparateForEveryPerson) {
  Trails trails(TrailSettings{{urdf::kPelvis}, 10});
  for (int i = 0; i < 3; ++i) {
    SceneState scene = SceneOnItsWay(0.1 * i);
    scene.people.push_back(SceneOnItsWay(5 + 0.1 * i).people[0]);
    scene.people[1].character = 1;
    trails.Remember(scene);
  }
  const auto made = trails.Make();
  ASSERT_THAT(made, SizeIs(2));
  EXPECT_NEAR(made[0].points.front().x(), 0, 1e-9);
  EXPECT_NEAR(made[1].points.front().x(), 5, 1e-9);
}

TEST(Trails, LoseTheirLaterPointsWhenARecordingStartsAgain) {
  Trails trails(TrailSettings{{urdf::kPelvis}, 10});
  RememberTenths(trails, 0, 10);
  RememberTenths(trails, 3, 4);
  const auto made = trails.Make();
  ASSERT_THAT(made, SizeIs(1));
  EXPECT_THAT(made[0].points, SizeIs(5)) << "0.0 to 0.4 s";
  EXPECT_NEAR(made[0].points.back().x(), 0.4, 1e-9);
}

TEST(Trails, HaveOnePointForARepeatedScene) {
  Trails trails(TrailSettings{{urdf::kPelvis}, 10});
  RememberTenths(trails, 0, 2);
  RememberTenths(trails, 2, 2);
  EXPECT_THAT(trails.Make().at(0).points, SizeIs(3));
}

TEST(Trails, DoNotGrowAfterTheStreamStopped) {
  Trails trails(TrailSettings{{urdf::kPelvis}, 1});
  RememberTenths(trails, 0, 2);
  SceneState stale = SceneOnItsWay(0.3);
  stale.liveness = Liveness::kStale;
  trails.Remember(stale);
  EXPECT_THAT(trails.Make().at(0).points, SizeIs(3));
}

}  // namespace
}  // namespace kinescope::app
