// Everything with a place goes up with the floor.
#include "render/floor_lift.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "tests/render/test_scene.h"
#include "tests/worn.h"

namespace kinescope::render {
namespace {

// Heights of all that is drawn, in an order of this test's own.
std::vector<double> HeightsOf(const SceneState& scene, const Camera& camera,
                              const PictureSpec& spec) {
  std::vector<double> heights = {camera.position.z(), camera.target.z()};
  const auto add = [&](const Eigen::Vector3d& point) { heights.push_back(point.z()); };
  const auto add_person = [&](const PersonState& person) {
    for (const urdf::Pose& link : person.links) add(link.position);
    for (const auto& glove : person.gloves) {
      if (!glove) continue;
      for (const urdf::Pose& link : glove->links) add(link.position);
    }
    for (const auto& prop : person.props) {
      if (prop) add(prop->pose.position);
    }
    for (const JointLoad& load : person.loads) add(load.position);
    for (const FootForce& foot : person.forces.feet) add(foot.cop);
    for (const HandForce& hand : person.forces.hands) {
      add(hand.point);
      add(hand.grip);
    }
    if (person.com) add(*person.com);
    if (person.cop) add(*person.cop);
  };
  for (const PersonState& person : scene.people) add_person(person);
  for (const Ghost& ghost : spec.look.ghosts) add_person(ghost.person);
  for (const TrackedObject& object : scene.objects) add(object.pose.position);
  for (const RobotState& robot : scene.robots) {
    for (const Eigen::Isometry3d& link : robot.world_from_link) add(link.translation());
  }
  for (const auto& marker : scene.markers) add(marker->pose.position);
  for (const auto& image : scene.images) add(image->camera->world_from_optical.position);
  for (const Pane& pane : spec.panes) {
    add(pane.camera.position);
    add(pane.camera.target);
  }
  for (const Trail& trail : spec.look.trails) {
    for (const Eigen::Vector3d& point : trail.points) add(point);
  }
  return heights;
}

TEST(LiftToFloor, RaisesEverythingWithAPositionWithoutSidewaysMotion) {
  SceneState scene = testing::SceneWith(testing::Posture::kStanding);
  scene.floor_z = -0.75;
  testing::Wear(scene.people[0]);
  scene.objects.emplace_back();
  auto taken = std::make_shared<CameraImage>();
  taken->camera = ImageCamera{};
  scene.images = {taken};
  scene.robots.emplace_back();
  scene.robots[0].world_from_link.assign(2, Eigen::Isometry3d::Identity());
  const auto marker = std::make_shared<const SceneMarker>();
  scene.markers.push_back(marker);
  Camera camera;
  PictureSpec spec;
  spec.panes.resize(2);
  spec.look.trails.resize(1);
  spec.look.trails[0].points = {{1, 2, 3}, {4, 5, 6}};
  spec.look.ghosts.push_back({scene.people[0], 0.5});

  std::vector<double> expected = HeightsOf(scene, camera, spec);
  for (double& height : expected) height += 0.75;
  const SceneState before = scene;
  LiftToFloor(scene, camera, spec);

  EXPECT_EQ(scene.floor_z, 0);
  const std::vector<double> heights = HeightsOf(scene, camera, spec);
  ASSERT_EQ(heights.size(), expected.size());
  for (std::size_t i = 0; i < heights.size(); ++i) EXPECT_NEAR(heights[i], expected[i], 1e-12) << i;
  for (std::size_t i = 0; i < before.people[0].links.size(); ++i) {
    EXPECT_EQ(scene.people[0].links[i].position.head<2>(),
              before.people[0].links[i].position.head<2>());
  }
  EXPECT_EQ(marker->pose.position.z(), 0) << "a marker is shared and must not be changed";
}

TEST(LiftToFloor, ChangesNothingIfTheFloorIsAtZero) {
  SceneState scene = testing::SceneWith(testing::Posture::kDeepBend);
  Camera camera;
  PictureSpec spec;
  const std::vector<double> before = HeightsOf(scene, camera, spec);
  LiftToFloor(scene, camera, spec);
  EXPECT_EQ(HeightsOf(scene, camera, spec), before);
}

}  // namespace
}  // namespace kinescope::render
