#include "render/camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/vec4.hpp>

#include "render/camera_matrices.h"
#include "server/core/errors.h"
#include "tests/render/test_scene.h"

namespace kinescope::render {
namespace {

using Eigen::Vector3d;

Camera AtTenMetres() {
  Camera camera;
  camera.position = {10, 0, 1};
  camera.target = {0, 0, 1};
  return camera;
}

TEST(Camera, ProjectsItsTargetToTheMiddle) {
  const Projected middle = Project({0, 0, 1}, AtTenMetres(), 1280, 720);
  EXPECT_NEAR(middle.x_px, 640, 1e-9);
  EXPECT_NEAR(middle.y_px, 360, 1e-9);
  EXPECT_NEAR(middle.depth_m, 10, 1e-12);
}

TEST(Camera, ProjectsByThePinholeFormula) {
  const Camera camera = AtTenMetres();
  const double px_per_m = 720 / (2 * std::tan(camera.vertical_fov_rad / 2) * 10);
  // Seen from +x, the world's +y is on the right and +z is up.
  const Projected point = Project({0, 0.5, 1.25}, camera, 1280, 720);
  EXPECT_NEAR(point.px_per_m, px_per_m, 1e-9);
  EXPECT_NEAR(point.x_px, 640 + 0.5 * px_per_m, 1e-9);
  EXPECT_NEAR(point.y_px, 360 - 0.25 * px_per_m, 1e-9);
  const Projected nearer = Project({5, 0.5, 1.25}, camera, 1280, 720);
  EXPECT_NEAR(nearer.px_per_m, 2 * px_per_m, 1e-9);
}

TEST(Camera, SaysWhatIsBehindIt) {
  EXPECT_LT(Project({11, 0, 1}, AtTenMetres(), 1280, 720).depth_m, 0);
}

TEST(Camera, ShowsTheEdgesOfItsFieldAtTheEdgesOfThePicture) {
  const Camera camera = AtTenMetres();
  const double half = 10 * std::tan(camera.vertical_fov_rad / 2);
  EXPECT_NEAR(Project({0, 0, 1 + half}, camera, 640, 480).y_px, 0, 1e-9);
  EXPECT_NEAR(Project({0, 0, 1 - half}, camera, 640, 480).y_px, 480, 1e-9);
  EXPECT_NEAR(Project({0, half * 640 / 480, 1}, camera, 640, 480).x_px, 640, 1e-9);
}

TEST(Camera, NamesAreThoseThatPeopleKnow) {
  EXPECT_THAT(CameraNames(), ::testing::ElementsAre("front", "back", "left", "right", "top", "iso",
                                                    "three_quarter"));
  for (const std::string& name : CameraNames()) EXPECT_NO_THROW(NamedCamera(name, SceneState()));
}

TEST(Camera, AnUnknownNameIsAnsweredWithTheKnownOnes) {
  try {
    NamedCamera("botom", SceneState());
    FAIL() << "took a camera that does not exist";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("botom"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr("three_quarter"));
  }
}

TEST(Camera, FrontLooksThePersonInTheFace) {
  const Camera front = NamedCamera("front", SceneState());
  EXPECT_GT(front.position.x(), front.target.x() + 2);
  EXPECT_NEAR(front.position.y(), 0, 1e-9);
  // The person's left hand (+y) is then on the right of the picture.
  EXPECT_GT(Project({0, 0.5, 1}, front, 1280, 720).x_px, 640);
  EXPECT_GT(NamedCamera("left", SceneState()).position.y(), 2);
  EXPECT_LT(NamedCamera("right", SceneState()).position.y(), -2);
  EXPECT_LT(NamedCamera("back", SceneState()).position.x(), -2);
  EXPECT_GT(NamedCamera("top", SceneState()).position.z(), 4);
}

TEST(Camera, EveryViewHoldsAnAdultWithArmsOverheadWhereverTheyStand) {
  const SceneState state =
      testing::SceneWith(testing::Posture::kStanding, LoadClass::kLow, 3.5, -2.25);
  for (const std::string& name : CameraNames()) {
    const Camera camera = NamedCamera(name, state);
    for (const double z : {0.0, 2.2}) {
      for (const double side : {-0.25, 0.25}) {
        const Projected at = Project({3.5 + side, -2.25 + side, z}, camera, 1280, 720);
        EXPECT_GT(at.depth_m, 0) << name;
        EXPECT_TRUE(at.x_px > 0 && at.x_px < 1280 && at.y_px > 0 && at.y_px < 720)
            << name << ": z " << z << " lands at " << at.x_px << ", " << at.y_px;
      }
    }
  }
}

TEST(Camera, AGroupFitsIntoThePicture) {
  SceneState state = testing::SceneWith(testing::Posture::kStanding, LoadClass::kLow, 0, -2);
  state.people.push_back(
      testing::SceneWith(testing::Posture::kStanding, LoadClass::kLow, 0, 2).people[0]);
  for (const std::string& name : CameraNames()) {
    const Camera camera = NamedCamera(name, state);
    for (const PersonState& person : state.people) {
      const Vector3d& head = person.links[urdf::kHead].position;
      const Projected at = Project(head, camera, 960, 720);
      EXPECT_TRUE(at.x_px > 0 && at.x_px < 960 && at.y_px > 0 && at.y_px < 720)
          << name << ": a head at " << at.x_px << ", " << at.y_px;
    }
  }
}

TEST(SteadyCamera, StandsStillUntilSomebodyWalksAway) {
  SteadyCamera steady;
  const auto at = [](double x) {
    return testing::SceneWith(testing::Posture::kStanding, LoadClass::kLow, x, 0);
  };
  const Camera first = steady.Aim("front", at(0));
  EXPECT_EQ(first.target, NamedCamera("front", at(0)).target);
  EXPECT_EQ(steady.Aim("front", at(0.3)).position, first.position);
  EXPECT_EQ(steady.Aim("front", at(-0.3)).position, first.position);
  // Drawn along without a jump: as much further as they went.
  const double near = steady.Aim("front", at(0.5)).target.x();
  const double far = steady.Aim("front", at(0.51)).target.x();
  EXPECT_GT(near, first.target.x());
  EXPECT_NEAR(far - near, 0.01, 1e-12);
  EXPECT_EQ(steady.Aim("front", at(0.4)).target.x(), far) << "turning back does not drag it back";
}

TEST(SteadyCamera, WaitsWhereItIsWhileNobodyIsThere) {
  SteadyCamera steady;
  const SceneState there = testing::SceneWith(testing::Posture::kStanding, LoadClass::kLow, 4, 2);
  EXPECT_NEAR(steady.Aim("left", SceneState()).target.x(), 0, 1e-12);
  const Camera first = steady.Aim("left", there);
  EXPECT_EQ(first.target, NamedCamera("left", there).target) << "the first to come are met at once";
  EXPECT_EQ(steady.Aim("left", SceneState()).target, first.target);
  EXPECT_EQ(steady.Aim("top", there).position, NamedCamera("top", there).position)
      << "a new name is a cut";
  EXPECT_THROW(steady.Aim("nowhere", there), UsageError);
}

TEST(Camera, LooksStraightDownWithoutLosingItsBearings) {
  Camera camera;
  camera.position = {1, 2, 8};
  camera.target = {1, 2, 0};
  camera.up = Vector3d::UnitZ();  // of no use here
  const Projected at = Project({1, 2, 0}, camera, 100, 100);
  EXPECT_NEAR(at.x_px, 50, 1e-9);
  EXPECT_NEAR(at.y_px, 50, 1e-9);
}

TEST(Camera, ATileShowsItsPartOfThePicture) {
  const Camera camera = AtTenMetres();
  const Tile tile{300, 100, 400, 200};
  const Vector3d point(1, -0.7, 1.3);
  const Projected whole = Project(point, camera, 1280, 720);
  const glm::dvec4 clip = TileFromClip(tile, 1280, 720) * ClipFromView(camera, 1280.0 / 720) *
                          ViewFromWorld(camera) * glm::dvec4(point.x(), point.y(), point.z(), 1);
  EXPECT_NEAR((clip.x / clip.w + 1) / 2 * tile.width, whole.x_px - tile.x, 1e-9);
  EXPECT_NEAR((1 - clip.y / clip.w) / 2 * tile.height, whole.y_px - tile.y, 1e-9);
}

}  // namespace
}  // namespace kinescope::render
