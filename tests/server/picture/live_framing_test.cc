// Live pictures of people who are wider than high, in pictures of two shapes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/person_outline.h"
#include "render/camera/camera.h"
#include "server/picture/camera_controller.h"
#include "server/picture/drawing_loop.h"
#include "server/picture/picture_shapes.h"
#include "tests/render/test_scene.h"

namespace kinescope::app {
namespace {

using Eigen::Vector3d;
using kinescope::testing::Posture;
using kinescope::testing::SceneWith;

constexpr std::pair<int, int> kSizes[] = {{1280, 720}, {640, 480}};

// On the right side, the head to the person's left.
SceneState Lying() {
  SceneState state = SceneWith(Posture::kStanding);
  PersonState& person = state.people[0];
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(M_PI / 2, -Vector3d::UnitX()));
  constexpr double kHalfBreadth = 0.25, kPelvis = 0.95;  // m
  for (urdf::Pose& link : person.links) {
    link.position = turn * (link.position - Vector3d(0, 0, kPelvis)) + Vector3d(0, 0, kHalfBreadth);
    link.orientation = turn * link.orientation;
  }
  person.com.reset();
  person.cop.reset();
  person.loads.clear();
  return state;
}

SceneState FourInARow() {
  SceneState state = SceneWith(Posture::kStanding, LoadClass::kLow, 0, -1.8);
  for (const double y : {-0.6, 0.6, 1.8}) {
    state.people.push_back(SceneWith(Posture::kStanding, LoadClass::kLow, 0, y).people[0]);
  }
  return state;
}

// What people cover.
render::PictureRect ShownIn(const SceneState& state, const render::Camera& camera, int width,
                            int height) {
  render::PictureRect shown{1, 1, 0, 0};
  for (const PersonState& person : state.people) {
    for (const Ball& ball : BallsOf(person)) {
      const render::Projected at = render::Project(ball.center, camera, width, height);
      const double radius = at.px_per_m * ball.radius;
      shown = {std::min(shown.left, (at.x_px - radius) / width),
               std::min(shown.top, (at.y_px - radius) / height),
               std::max(shown.right, (at.x_px + radius) / width),
               std::max(shown.bottom, (at.y_px + radius) / height)};
    }
  }
  return shown;
}

// `least`: of the width or height that is free beside or above the corners.
void ExpectFilled(const render::PictureRect& shown, const render::FreeArea& area, double least) {
  const render::PictureRect& free = area.free;
  const double width = free.right - free.left, height = free.bottom - free.top;
  double beside = width, above = height;
  for (const render::PictureRect& corner : area.corners) {
    const bool is_across = shown.left < corner.right && shown.right > corner.left;
    const bool is_upright = shown.top < corner.bottom && shown.bottom > corner.top;
    EXPECT_FALSE(is_across && is_upright) << "the corner from " << corner.left;
    if (is_across) above -= corner.bottom - corner.top;
    if (is_upright) beside -= corner.right - corner.left;
  }
  const double across = shown.right - shown.left, upright = shown.bottom - shown.top;
  EXPECT_GT(std::max(across / beside, upright / above), least) << across << " x " << upright;
  EXPECT_LT(std::max(across / width, upright / height), 0.85) << across << " x " << upright;
  EXPECT_GT(shown.left, free.left);
  EXPECT_LT(shown.right, free.right);
  EXPECT_GT(shown.top, free.top);
  EXPECT_LT(shown.bottom, free.bottom);
}

TEST(LiveFraming, FillsThePictureWithALyingPerson) {
  const SceneState state = Lying();
  for (const auto& [width, height] : kSizes) {
    for (const char* name : {"front", "three_quarter", "iso", "top"}) {
      SCOPED_TRACE(std::string(name) + " " + std::to_string(width));
      const render::ViewShape shape = PictureShapes().Of(LiveView(width, height), state);
      ASSERT_FALSE(shape.area.corners.empty()) << "a legend";
      CameraController controller(ParseCamera(name), {});
      const render::Camera camera = controller.AimLive(state, shape);
      ExpectFilled(ShownIn(state, camera, width, height), shape.area, 0.6);
    }
  }
}

TEST(LiveFraming, FillsThePictureWithFourPeopleInARow) {
  const SceneState state = FourInARow();
  for (const auto& [width, height] : kSizes) {
    for (const char* name : {"front", "back", "three_quarter"}) {
      SCOPED_TRACE(std::string(name) + " " + std::to_string(width));
      const render::ViewShape shape = PictureShapes().Of(LiveView(width, height), state);
      CameraController controller(ParseCamera(name), {});
      const render::Camera camera = controller.AimLive(state, shape);
      ExpectFilled(ShownIn(state, camera, width, height), shape.area, 0.6);
    }
  }
}

TEST(LiveFraming, FramesPeopleWhoComeLaterAsIfTheyHadBeenThere) {
  const SceneState state = Lying();
  const render::ViewShape live = PictureShapes().Of(LiveView(1280, 720), state);
  CameraController early(ParseCamera("front"), {}), late = early;
  late.AimLive(SceneState(), live);
  EXPECT_EQ(late.AimLive(state, live).position, early.AimLive(state, live).position);
}

TEST(LiveFraming, ShowsTheSamePeopleInSnapshotsOfOtherShapes) {
  const SceneState state = FourInARow();
  const render::ViewShape live = PictureShapes().Of(LiveView(1280, 720), state);
  CameraController controller(ParseCamera("front"), {});
  for (const auto& [width, height] : {std::pair{480, 640}, {640, 480}, {1920, 480}}) {
    const render::ViewShape shape = PictureShapes().Of(LiveView(width, height), state);
    const render::Camera camera = controller.AimLive(state, live, shape);
    ExpectFilled(ShownIn(state, camera, width, height), shape.area, 0.45);
  }
}

// The camera stands still for a person who walks to and fro: without more, it would stand still for
// one who walks behind the legend.
TEST(LiveFraming, KeepsAWalkerBesideTheLegend) {
  for (const bool is_left : {true, false}) {
    const render::PictureRect legend =
        is_left ? render::PictureRect{0, 0.55, 0.3, 1} : render::PictureRect{0.7, 0.55, 1, 1};
    const render::ViewShape shape{16.0 / 9, {{}, {legend}}};
    CameraController controller(ParseCamera("front"), {});
    SceneState state = SceneWith(Posture::kStanding);
    double least = 1, most = 0, before = 0, fastest = 0, was = 0;
    constexpr double kInterval = 1.0 / 15, kSpeed = 1.2;  // s, m/s
    for (double secs = 0; secs < 12; secs += kInterval) {
      constexpr double kFarthest = 1.5;  // m, to both sides
      const double y = kFarthest * std::asin(std::sin(M_PI_2 * kSpeed * secs / kFarthest)) / M_PI_2;
      for (urdf::Pose& link : state.people[0].links) link.position.y() += y - was;
      was = y;
      state.stamp_nanos = 5'000'000'000 + std::llround(1e9 * secs);
      const render::Camera camera = controller.AimLive(state, shape);
      const render::PictureRect shown = ShownIn(state, camera, 1280, 720);
      ASSERT_GT(shown.bottom, legend.top) << "else it could walk above the legend";
      least = std::min(least, shown.left);
      most = std::max(most, shown.right);
      const double at = camera.target.y();
      if (secs > 0) fastest = std::max(fastest, std::abs(at - before) / kInterval);
      before = at;
    }
    EXPECT_GT(least, is_left ? 0.299 : 0.0);
    EXPECT_LT(most, is_left ? 1.0 : 0.701);
    EXPECT_LT(fastest, 4) << "m/s: the picture jumps";
  }
}

}  // namespace
}  // namespace kinescope::app
