#include "render/camera/framing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/render/test_scene.h"

namespace kinescope::render {
namespace {

using Eigen::Vector3d;
using kinescope::testing::Posture;

// Balls in a picture 1 high and `aspect` wide.
PictureRect Shown(const std::vector<Ball>& balls, const Camera& camera, double aspect) {
  constexpr int kHeight = 10'000;
  const int width = static_cast<int>(kHeight * aspect);
  PictureRect shown{1e9, 1e9, -1e9, -1e9};
  for (const Ball& ball : balls) {
    const Projected at = Project(ball.center, camera, width, kHeight);
    EXPECT_GT(at.depth_m, 0);
    const double radius = ball.radius * at.px_per_m;
    shown.left = std::min(shown.left, (at.x_px - radius) / width);
    shown.right = std::max(shown.right, (at.x_px + radius) / width);
    shown.top = std::min(shown.top, (at.y_px - radius) / kHeight);
    shown.bottom = std::max(shown.bottom, (at.y_px + radius) / kHeight);
  }
  return shown;
}

std::vector<SceneState> Scenes() {
  std::vector<SceneState> scenes;
  for (const Posture posture : {Posture::kStanding, Posture::kDeepBend, Posture::kArmsForward}) {
    scenes.push_back(testing::BodyAlone(posture));
  }
  SceneState lying = testing::BodyAlone();
  for (urdf::Pose& link : lying.people[0].links) {
    const Eigen::AngleAxisd turn(M_PI / 2, Vector3d::UnitY());
    link.position = turn * link.position;
    link.orientation = turn * link.orientation;
  }
  scenes.push_back(lying);
  return scenes;
}

std::vector<Camera> Cameras() {
  std::vector<Camera> cameras;
  for (const std::string& name : CameraNames()) {
    cameras.push_back(NamedCamera(name, SceneState()));
    cameras.push_back(Orthographic(cameras.back()));
  }
  return cameras;
}

TEST(Framing, FillsMostOfTheFreeHeightOrWidthInEveryPosture) {
  FreeArea area;
  area.free = {0, 0.07, 1, 0.95};
  for (const SceneState& scene : Scenes()) {
    const std::vector<Ball> balls = BallsOf(scene);
    for (const Camera& camera : Cameras()) {
      for (const double aspect : {16.0 / 9, 1.0, 9.0 / 16}) {
        const PictureRect shown = Shown(balls, Framing(camera, balls, aspect, area), aspect);
        const double height = (shown.bottom - shown.top) / (area.free.bottom - area.free.top);
        const double width = shown.right - shown.left;
        EXPECT_LE(std::max(height, width), kFilled + 0.01);
        EXPECT_GE(std::max(height, width), kFilled - 0.04);
        EXPECT_GT(shown.top, area.free.top);
        EXPECT_LT(shown.bottom, area.free.bottom);
        EXPECT_NEAR(shown.left + shown.right, 1, 0.06) << "in the middle";
      }
    }
  }
}

TEST(Framing, KeepsPeopleOutOfCoveredCorners) {
  FreeArea area;
  area.corners = {{0, 0.6, 0.2, 1}, {0.85, 0.9, 1, 1}, {0.7, 0, 1, 0.4}};
  for (const SceneState& scene : Scenes()) {
    const std::vector<Ball> balls = BallsOf(scene);
    for (const Camera& camera : Cameras()) {
      for (const double aspect : {16.0 / 9, 1.0, 9.0 / 16}) {
        const Camera framed = Framing(camera, balls, aspect, area);
        for (const Ball& ball : balls) {
          const PictureRect shown = Shown({ball}, framed, aspect);
          for (const PictureRect& corner : area.corners) {
            EXPECT_FALSE(shown.left < corner.right && shown.right > corner.left &&
                         shown.top < corner.bottom && shown.bottom > corner.top);
          }
        }
      }
    }
  }
}

TEST(Framing, IgnoresCornersThatAreNotInTheWay) {
  const std::vector<Ball> balls = BallsOf(testing::BodyAlone());
  FreeArea area;
  area.corners = {{0, 0.6, 0.2, 1}};
  const Camera camera = NamedCamera("front", SceneState());
  EXPECT_EQ(Framing(camera, balls, 16.0 / 9, area).position,
            Framing(camera, balls, 16.0 / 9).position);
}

TEST(Framing, ShowsWhatPeopleHoldObjectsAndRobots) {
  SceneState scene = testing::BodyAlone();
  const double alone = ShownHeight(Framing(NamedCamera("front", scene), BallsOf(scene), 16.0 / 9));
  const auto with = [&](const SceneState& other) {
    return ShownHeight(Framing(NamedCamera("front", scene), BallsOf(other), 16.0 / 9));
  };
  SceneState cart = scene;
  cart.objects.push_back({});
  cart.objects.back().pose.position = {0, 0, 2.6};
  EXPECT_GT(with(cart), 1.3 * alone);
  SceneState robot = scene;
  robot.robots.emplace_back();
  robot.robots.back().bounds = {Vector3d(0, 0, 0), Vector3d(1, 1, 3)};
  EXPECT_GT(with(robot), 1.5 * alone);
}

TEST(Framing, LeavesOutWhoIsFarAwayAndWhatIsNotFinite) {
  SceneState scene = testing::BodyAlone();
  const std::size_t count = BallsOf(scene).size();
  scene.people.push_back(scene.people[0]);
  for (urdf::Pose& link : scene.people[1].links) link.position.x() += 900;
  EXPECT_EQ(BallsOf(scene).size(), count);
  scene.objects.push_back({});
  scene.objects.back().pose.position.x() = std::nan("");
  EXPECT_EQ(BallsOf(scene).size(), count);
  EXPECT_TRUE(BallsOf(SceneState()).empty());
}

TEST(BallHull, FramesEveryMomentAlmostAsTightlyAsAllBalls) {
  BallHull hull;
  std::vector<Ball> all;
  EXPECT_TRUE(hull.balls().empty());
  for (const SceneState& scene : Scenes()) {
    for (const Ball& ball : BallsOf(scene)) {
      hull.Add(ball);
      all.push_back(ball);
    }
  }
  for (const Camera& camera : Cameras()) {
    const Camera framed = Framing(camera, hull.balls(), 1.5);
    const PictureRect shown = Shown(all, framed, 1.5);
    const double size = std::max(shown.right - shown.left, shown.bottom - shown.top);
    EXPECT_LE(size, kFilled + 0.02);
    EXPECT_GE(size, kFilled - 0.04);
  }
}

}  // namespace
}  // namespace kinescope::render
