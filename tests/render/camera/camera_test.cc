#include "render/camera/camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <glm/vec4.hpp>

#include "core/system/errors.h"
#include "render/camera/camera_matrices.h"
#include "render/camera/camera_path.h"
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

TEST(Camera, ProjectsItsTargetToTheMiddleOfThePicture) {
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

TEST(Camera, ReportsANegativeDepthForPointsBehindIt) {
  EXPECT_LT(Project({11, 0, 1}, AtTenMetres(), 1280, 720).depth_m, 0);
}

TEST(Camera, MapsTheEdgesOfItsFieldOfViewToTheEdgesOfThePicture) {
  const Camera camera = AtTenMetres();
  const double half = 10 * std::tan(camera.vertical_fov_rad / 2);
  EXPECT_NEAR(Project({0, 0, 1 + half}, camera, 640, 480).y_px, 0, 1e-9);
  EXPECT_NEAR(Project({0, 0, 1 - half}, camera, 640, 480).y_px, 480, 1e-9);
  EXPECT_NEAR(Project({0, half * 640 / 480, 1}, camera, 640, 480).x_px, 640, 1e-9);
}

TEST(Camera, HasTheUsualNames) {
  EXPECT_THAT(CameraNames(), ::testing::ElementsAre("front", "back", "left", "right", "top", "iso",
                                                    "three_quarter"));
  for (const std::string& name : CameraNames()) EXPECT_NO_THROW(NamedCamera(name, SceneState()));
}

TEST(Camera, HasAnotherWordForTheRightSide) {
  const SceneState nobody;
  EXPECT_EQ(NamedCamera("side", nobody).position, NamedCamera("right", nobody).position);
}

TEST(Camera, RejectsAnUnknownNameAndListsTheKnownOnes) {
  try {
    NamedCamera("botom", SceneState());
    FAIL() << "took a camera that does not exist";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("botom"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr("three_quarter"));
  }
}

TEST(Camera, ShowsTheFaceFromTheFront) {
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

TEST(Camera, ShowsAnAdultWithArmsOverheadCompletelyInEveryView) {
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

TEST(Camera, ShowsAGroupCompletely) {
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

SceneState StandingAt(double x, double y) {
  return testing::SceneWith(testing::Posture::kStanding, LoadClass::kLow, x, y);
}

TEST(GroundExtent, IsThatOfThePeopleWhoCanBeSeenTogether) {
  SceneState state = StandingAt(1, 0);
  const double x = GroundExtentOf(state).middle.x();
  state.people.push_back(StandingAt(-900, 0).people[0]);
  EXPECT_EQ(GroundExtentOf(state).middle.x(), x) << "one who is far hides none";
  EXPECT_EQ(GroundExtentOf(state).radius, 0);
  state.people.push_back(StandingAt(31, 0).people[0]);
  EXPECT_NEAR(GroundExtentOf(state).middle.x(), x + 15, 1e-9);
  EXPECT_NEAR(GroundExtentOf(state).radius, 15, 1e-9);
}

TEST(SmoothedGroundExtent, StaysConstantUntilAPersonWalksAway) {
  SmoothedGroundExtent steady;
  const auto x_at = [&](double x) { return steady.Follow(StandingAt(x, 0)).middle.x(); };
  const double first = x_at(0);
  EXPECT_EQ(first, GroundExtentOf(StandingAt(0, 0)).middle.x());
  EXPECT_EQ(x_at(0.3), first);
  EXPECT_EQ(x_at(-0.3), first);
  // Drawn along without a jump: as much further as they went.
  const double near = x_at(0.5), far = x_at(0.51);
  EXPECT_GT(near, first);
  EXPECT_NEAR(far - near, 0.01, 1e-12);
  EXPECT_EQ(x_at(0.4), far) << "turning back does not drag them back";
}

TEST(SmoothedGroundExtent, StaysConstantWithoutAPerson) {
  SmoothedGroundExtent steady;
  const SceneState there = StandingAt(4, 2);
  EXPECT_NEAR(steady.Follow(SceneState()).middle.x(), 0, 1e-12);
  EXPECT_EQ(steady.Follow(there).middle, GroundExtentOf(there).middle)
      << "the first person sets it at once";
  EXPECT_EQ(steady.Follow(SceneState()).middle, GroundExtentOf(there).middle);
}

TEST(Camera, ShowsAMetreEquallyLargeAtAnyDepthWithoutPerspective) {
  const Camera perspective = NamedCamera("front", SceneState());
  const Camera camera = Orthographic(perspective);
  const double at_target = Project(camera.target, perspective, 640, 480).px_per_m;
  for (const double x : {-3.0, 0.0, 2.0}) {
    const Projected point = Project({x, 0, 1}, camera, 640, 480);
    EXPECT_NEAR(point.px_per_m, at_target, 1e-9) << "as large as it was at the target";
    EXPECT_NEAR(Project({x, 0.5, 1}, camera, 640, 480).x_px - point.x_px, 0.5 * at_target, 1e-9);
  }
}

TEST(Camera, KeepsTheSizeAtTheTargetWithAnotherLens) {
  const Camera camera = NamedCamera("iso", SceneState());
  const Camera wide = WithFov(camera, 1.2);
  EXPECT_NEAR(ShownHeight(wide), ShownHeight(camera), 1e-9);
  EXPECT_LT((wide.position - wide.target).norm(), (camera.position - camera.target).norm());
}

TEST(Camera, ShowsBothArmsInANarrowPicture) {
  const SceneState state = testing::SceneWith(testing::Posture::kStanding);
  for (const bool is_flat : {false, true}) {
    Camera camera = NamedCamera("front", state);
    if (is_flat) camera = Orthographic(camera);
    EXPECT_EQ(ForAspect(camera, 16.0 / 9).position, camera.position) << "wide enough";
    const Vector3d hand = GroundExtentOf(state).middle + Vector3d(0, 0.94, 1.06);
    EXPECT_GT(Project(hand, camera, 270, 480).x_px, 270);
    EXPECT_LT(Project(hand, ForAspect(camera, 270.0 / 480), 270, 480).x_px, 270);
  }
}

TEST(CameraPath, CirclesThePersonAndStandsStillAtBothEnds) {
  const Camera front = NamedCamera("front", SceneState());
  const std::vector<CameraKey> keys = {{1, front, Ease::kLinear},
                                       {3, NamedCamera("right", SceneState()), Ease::kSmooth},
                                       {5, NamedCamera("top", SceneState()), Ease::kHold},
                                       {6, front, Ease::kSmooth}};
  EXPECT_EQ(AlongPath(keys, 0).position, front.position);
  EXPECT_EQ(AlongPath(keys, 9).position, front.position);
  EXPECT_EQ(AlongPath(keys, 5.9).position, keys[2].camera.position) << "held";
  const double height = ShownHeight(front);
  Camera before = AlongPath(keys, 1);
  for (double secs = 1; secs < 5; secs += 0.01) {
    const Camera camera = AlongPath(keys, secs);
    const double distance = (camera.position - camera.target).norm();
    EXPECT_NEAR(ShownHeight(camera), height, 1e-9) << "the person keeps the size at " << secs;
    EXPECT_LT((camera.position - before.position).norm(), 0.02 * distance) << "no jump at " << secs;
    EXPECT_GT(camera.up.normalized().dot(before.up.normalized()), 0.99);
    if (secs < 3) {
      EXPECT_EQ(camera.up, Vector3d::UnitZ());
    }
    before = camera;
  }
  const Camera half = AlongPath(keys, 2);
  EXPECT_NEAR(half.position.x() - half.target.x(), half.target.y() - half.position.y(), 1e-9)
      << "half way between +x and -y";
}

TEST(Camera, LooksStraightDownWithoutADegenerateOrientation) {
  Camera camera;
  camera.position = {1, 2, 8};
  camera.target = {1, 2, 0};
  camera.up = Vector3d::UnitZ();  // of no use here
  const Projected at = Project({1, 2, 0}, camera, 100, 100);
  EXPECT_NEAR(at.x_px, 50, 1e-9);
  EXPECT_NEAR(at.y_px, 50, 1e-9);
}

TEST(Camera, ProjectsATileLikeItsPartOfThePicture) {
  const Camera camera = AtTenMetres();
  const Tile tile{300, 100, 400, 200};
  const Vector3d point(1, -0.7, 1.3);
  const Projected whole = Project(point, camera, 1280, 720);
  const glm::dvec4 clip = TileFromClip(tile, 1280, 720) * ClipFromView(camera, 1280.0 / 720) *
                          ViewFromWorld(camera) * glm::dvec4(point.x(), point.y(), point.z(), 1);
  EXPECT_NEAR((clip.x / clip.w + 1) / 2 * tile.width, whole.x_px - tile.x, 1e-9);
  EXPECT_NEAR((1 - clip.y / clip.w) / 2 * tile.height, whole.y_px - tile.y, 1e-9);
}

TEST(Camera, FindsTheFloorWhereAPointOfItIsProjected) {
  for (const std::string& name : CameraNames()) {
    for (const double ortho_height_m : {0.0, 2.5}) {
      Camera camera = NamedCamera(name, SceneState());
      camera.ortho_height_m = ortho_height_m;
      for (const Eigen::Vector3d& point :
           {Eigen::Vector3d(0.4, -0.3, 0), Eigen::Vector3d(-1, 2, 0)}) {
        const Projected at = Project(point, camera, 640, 360);
        ASSERT_GT(at.depth_m, 0);
        const auto found = FloorPointAt(at.x_px, at.y_px, camera, 640, 360);
        ASSERT_TRUE(found) << name;
        EXPECT_LT((*found - point.head<2>()).norm(), 1e-3) << name;
      }
    }
  }
  EXPECT_FALSE(FloorPointAt(320, 0, NamedCamera("front", SceneState()), 640, 360))
      << "above the horizon";
  Camera below;
  below.position = {3, 0, -1};
  below.target = {0, 0, -1};
  EXPECT_FALSE(FloorPointAt(320, 20, below, 640, 360));
}

TEST(Camera, FindsThePlaneThatPixelsShow) {
  std::vector<Camera> cameras;
  for (const std::string& name : CameraNames()) {
    cameras.push_back(NamedCamera(name, SceneState()));
    cameras.push_back(Orthographic(Turned(cameras.back(), 0.3)));
  }
  int seen = 0;
  for (const Camera& camera : cameras) {
    for (const double height : {0.0, 0.4}) {
      const auto plane = PlaneFromPicture(camera, 640, 360, height);
      if (!plane) continue;
      ++seen;
      for (const Eigen::Vector2d& at : {Eigen::Vector2d(0.2, -0.3), Eigen::Vector2d(-0.9, 0.1)}) {
        const Projected pixel = Project({at.x(), at.y(), height}, camera, 640, 360);
        const Eigen::Vector3d found = *plane * Eigen::Vector3d(pixel.x_px, pixel.y_px, 1);
        EXPECT_GT(found.z(), 0);
        EXPECT_LT((found.hnormalized() - at).norm(), 1e-9);
      }
    }
  }
  EXPECT_GT(seen, 20);
  Camera low;
  low.position = {3, 0, 0.5};
  low.target = {0, 0, 0.5};
  EXPECT_TRUE(PlaneFromPicture(low, 640, 360, 0));
  EXPECT_FALSE(PlaneFromPicture(low, 640, 360, 0.6)) << "from below";
  const auto plane = PlaneFromPicture(low, 640, 360, 0);
  EXPECT_LT((*plane * Eigen::Vector3d(320, 100, 1)).z(), 0) << "above the horizon";
}

}  // namespace
}  // namespace kinescope::render
