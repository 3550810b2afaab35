#include "core/scene_interpolation.h"

#include <gtest/gtest.h>

namespace kinescope {
namespace {

SceneState SceneAt(std::int64_t stamp_nanos, double x, LoadClass load_class) {
  SceneState scene;
  scene.stamp_nanos = stamp_nanos;
  scene.time_code_millis = stamp_nanos / 1'000'000;
  PersonState person;
  person.sample.time_code_millis = scene.time_code_millis;
  for (urdf::Pose& link : person.links) link.position.x() = x;
  person.com = Eigen::Vector3d(x, 0, 1);
  JointLoad load;
  load.joint = urdf::jRightElbow;
  load.load_class = load_class;
  person.loads.push_back(load);
  scene.people.push_back(person);
  return scene;
}

TEST(SceneInterpolation, InterpolatesPosesAndKeepsDiscreteValues) {
  const SceneState a = SceneAt(0, 0.0, LoadClass::kLow);
  const SceneState b = SceneAt(10'000'000, 1.0, LoadClass::kHigh);
  const SceneState between = Interpolate(a, b, 2'500'000);
  EXPECT_EQ(between.stamp_nanos, 2'500'000);
  EXPECT_EQ(between.time_code_millis, 3);
  const PersonState& person = between.people.at(0);
  EXPECT_DOUBLE_EQ(person.links[urdf::kHead].position.x(), 0.25);
  EXPECT_DOUBLE_EQ(person.com->x(), 0.25);
  EXPECT_DOUBLE_EQ(person.loads.at(0).position.x(), 0.25) << "a sphere stays at its joint";
  EXPECT_EQ(person.loads.at(0).load_class, LoadClass::kLow);
}

// Two suits have clocks of their own, and the state that of whoever's sample is the newest.
TEST(SceneInterpolation, HasTheTimeCodeOfOnePersonAndNoneBetweenTwoClocks) {
  constexpr std::int64_t kOther = 5000;  // ms, of the second suit ahead of the first
  const auto scene_at = [](std::int64_t millis, int newest) {
    SceneState scene = SceneAt(millis * 1'000'000, 0, LoadClass::kLow);
    scene.people.push_back(scene.people[0]);
    scene.people[1].character = 1;
    scene.people[1].sample.time_code_millis = kOther + millis - (newest == 1 ? 0 : 5);
    scene.people[0].sample.time_code_millis = millis - (newest == 0 ? 0 : 5);
    for (PersonState& person : scene.people) {
      person.sample.counter = static_cast<std::uint32_t>(person.sample.time_code_millis);
    }
    const BodySample& sample = scene.people[static_cast<std::size_t>(newest)].sample;
    scene.counter = sample.counter;
    scene.time_code_millis = sample.time_code_millis;
    return scene;
  };
  EXPECT_EQ(Interpolate(scene_at(100, 0), scene_at(110, 1), 105'000'000).time_code_millis, 103);
  EXPECT_EQ(Interpolate(scene_at(110, 1), scene_at(120, 0), 115'000'000).time_code_millis,
            kOther + 113);
}

TEST(SceneInterpolation, InterpolatesGlovesPropsAndObjectsToo) {
  using Eigen::Quaterniond;
  const auto scene_at = [](std::int64_t stamp, double x, double angle, double sign) {
    SceneState scene = SceneAt(stamp, x, LoadClass::kLow);
    urdf::Pose pose;
    pose.position.x() = x;
    pose.orientation = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ());
    pose.orientation.coeffs() *= sign;
    scene.people[0].gloves[urdf::kLeft].emplace().links.fill(pose);
    scene.people[0].props[2].emplace().pose = pose;
    scene.objects = {{3, 0, "other", {}, stamp}, {3, 1, "tool", pose, stamp}};
    return scene;
  };
  const SceneState a = scene_at(0, 0, 0.2, 1);
  SceneState b = scene_at(10'000'000, 1, 0.6, -1);  // the other of a turn's two quaternions
  b.objects.erase(b.objects.begin());
  const SceneState between = Interpolate(a, b, 2'500'000);
  const Quaterniond turn(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()));
  for (const urdf::Pose& pose : {between.people[0].gloves[urdf::kLeft]->links[7],
                                 between.people[0].props[2]->pose, between.objects.at(1).pose}) {
    EXPECT_DOUBLE_EQ(pose.position.x(), 0.25);
    EXPECT_LT(pose.orientation.angularDistance(turn), 1e-9);
  }
  EXPECT_EQ(between.objects.at(0).pose.position.x(), 0) << "an object that leaves is held";
  EXPECT_FALSE(between.people[0].gloves[urdf::kRight]);
}

TEST(SceneInterpolation, ReturnsTheNearerStateOutsideTheInterval) {
  const SceneState a = SceneAt(0, 0.0, LoadClass::kLow);
  const SceneState b = SceneAt(10, 1.0, LoadClass::kHigh);
  EXPECT_EQ(Interpolate(a, b, -5).people[0].com->x(), 0);
  EXPECT_EQ(Interpolate(a, b, 50).people[0].com->x(), 1);
  EXPECT_EQ(Interpolate(b, a, 5).people[0].com->x(), 1) << "time ran backwards: hold";
}

TEST(SceneInterpolation, KeepsAPersonWhoLeavesInPlace) {
  const SceneState a = SceneAt(0, 0.0, LoadClass::kLow);
  SceneState b = SceneAt(10, 1.0, LoadClass::kLow);
  b.people[0].character = 5;
  EXPECT_EQ(Interpolate(a, b, 5).people.at(0).com->x(), 0);
}

}  // namespace
}  // namespace kinescope
