#include "render/camera/held_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/render/test_scene.h"

namespace kinescope::render {
namespace {

using Eigen::Vector3d;
using kinescope::testing::BodyAlone;
using kinescope::testing::Posture;

// Looks along -x; held_view.test.mjs has the same.
Camera Level() {
  Camera camera;
  camera.position = {4, 0, 1};
  camera.target = {0, 0, 1};
  camera.vertical_fov_rad = 0.52;
  return camera;
}

const ViewShape kWide{16.0 / 9, {}};
ViewHull Box(const Vector3d& low, const Vector3d& high) {
  ViewHull hull;
  for (int i = 0; i < 8; ++i) {
    hull.Add({{i % 2 > 0 ? high.x() : low.x(), i / 2 % 2 > 0 ? high.y() : low.y(),
               i / 4 > 0 ? high.z() : low.z()},
              0});
  }
  return hull;
}
const ViewHull kStanding = Box({-0.3, 0, -0.2}, {0.3, 1.8, 0.3});
const ViewHull kSitting = Box({-0.3, 0, -0.5}, {0.3, 1.2, 0.5});
const ViewHull kOverhead = Box({-0.3, 0, -0.2}, {0.3, 2.2, 0.3});
const ViewHull kLying = Box({-0.9, 0, -0.3}, {0.9, 0.3, 0.3});

double HeightFor(const ViewHull& hull) { return PlaceFor(hull, Level(), kWide).height; }

// What is shown after `secs` more seconds in which `needed` is constant.
class HeldTake {
 public:
  double Play(const ViewHull& needed, double secs) {
    const double end = secs_ + secs;
    for (; secs_ < end; secs_ += 1.0 / 30) {
      const double before = shown_.height;
      shown_ = held_.Follow(needed, Level(), kWide, secs_);
      if (before > 0) {
        EXPECT_LT(std::abs(shown_.height - before), 0.08) << "jumps at " << secs_;
        moved_ += std::abs(shown_.height - before) > 0.0005 ? 1 : 0;
      }
    }
    return shown_.height;
  }
  int moved() const { return moved_; }

 private:
  HeldView held_;
  double secs_ = 0;
  ViewPlace shown_;
  int moved_ = 0;
};

// The same numbers as on the page.
TEST(PlaceFor, FillsHeightOrWidthOfWhatIsFree) {
  const auto expect = [](const ViewHull& hull, const ViewShape& shape, const ViewPlace& expected) {
    const ViewPlace place = PlaceFor(hull, Level(), shape);
    EXPECT_NEAR(place.right, expected.right, 2e-4);
    EXPECT_NEAR(place.up, expected.up, 2e-4);
    EXPECT_NEAR(place.height, expected.height, 2e-4);
  };
  const FreeArea title{{0, 0.1, 1, 1}, {}};
  const FreeArea legend{{0, 0.1, 1, 1}, {{0, 0.6, 0.3, 1}}};
  expect(kStanding, kWide, {0, 0.9, 2.4748});
  expect(kStanding, {4.0 / 3, title}, {0, 1.0316, 2.738});
  expect(kLying, kWide, {0, 0.15, 1.4918});
  expect(kLying, {4.0 / 3, title}, {0, 0.2388, 1.9359});
  expect(kLying, {16.0 / 9, legend}, {0, -0.0498, 1.4918});
}

// The same numbers as on the page.
TEST(BesideCorners, MovesThePictureOnlyWherePeopleWouldBeCovered) {
  const PictureRect legend{0, 0.6, 0.3, 1};
  const auto right_for = [&](double to_right, const std::vector<PictureRect>& corners) {
    const ViewShape shape{16.0 / 9, {{0, 0.1, 1, 1}, corners}};
    return BesideCorners({0, 0.9, 2.4748}, kStanding, {0, to_right, 0}, Level(), shape).right;
  };
  EXPECT_EQ(right_for(0, {legend}), 0);
  EXPECT_NEAR(right_for(-1.2, {legend}), -0.6579, 2e-4);
  EXPECT_NEAR(right_for(2.5, {legend}), 0.6948, 2e-4) << "or leave the picture";
  EXPECT_NEAR(right_for(0.5, {legend, {0.6, 0.6, 1, 1}}), 0.3790, 2e-4);
  EXPECT_NEAR(right_for(0.5, {legend, {0.4, 0.6, 1, 1}}), 1.1552, 2e-4) << "in their middle";
  EXPECT_EQ(right_for(-1.2, {}), 0) << "the ground under the camera moves then";
}

TEST(HeldView, ComesNearerSlowlyAfterTwoSecondsAndMakesRoomAtOnce) {
  const double standing = HeightFor(kStanding), sitting = HeightFor(kSitting);
  const double overhead = HeightFor(kOverhead);
  HeldTake take;
  take.Play(kStanding, 5);
  EXPECT_EQ(take.Play(kSitting, 1.8), standing);
  EXPECT_GT(take.Play(kSitting, 1), 0.75 * standing);
  EXPECT_NEAR(take.Play(kSitting, 4), sitting, 0.05);
  EXPECT_GT(take.Play(kOverhead, 0.6), 0.85 * overhead);
  const double settled = take.Play(kOverhead, 3);
  EXPECT_GE(settled, 0.98 * overhead);
  EXPECT_LT(settled, 1.1 * overhead);
}

TEST(HeldView, LearnsToStandStillForAPersonWhoBendsAndRisesAgain) {
  HeldTake take;
  for (int i = 0; i < 3; ++i) {
    take.Play(kStanding, 3);
    take.Play(kSitting, 4);
  }
  const int learnt = take.moved();
  for (int i = 0; i < 10; ++i) {
    EXPECT_GE(take.Play(kStanding, 3), 0.85 * HeightFor(kStanding));
    take.Play(kSitting, 4);
  }
  EXPECT_LT(take.moved(), learnt + 60) << "pictures in which it zooms";
  take.Play(kSitting, 30);
  take.Play(kStanding, 30);
  EXPECT_NEAR(take.Play(kSitting, 6), HeightFor(kSitting), 0.05) << "it waits two seconds again";
}

TEST(HeldView, IgnoresSmallDifferences) {
  HeldTake take;
  take.Play(kStanding, 2);
  const double held = HeightFor(kStanding);
  EXPECT_EQ(take.Play(Box({-0.6, -0.05, -0.2}, {0.5, 1.9, 0.3}), 5), held);
  EXPECT_EQ(take.Play(Box({-0.3, 0, -0.2}, {0.3, 1.65, 0.3}), 30), held);
  EXPECT_EQ(take.moved(), 0);
}

TEST(HeldView, BeginsAnewWhereTimeGoesBack) {
  HeldView held;
  held.Follow(kOverhead, Level(), kWide, 100);
  EXPECT_EQ(held.Follow(kSitting, Level(), kWide, 3).height, HeightFor(kSitting));
}

TEST(NeededHull, LetsEveryPostureFillMostOfThePicture) {
  for (const Posture posture : {Posture::kStanding, Posture::kDeepBend, Posture::kArmsForward}) {
    const SceneState state = BodyAlone(posture);
    for (const char* name : {"front", "left", "three_quarter", "top", "iso"}) {
      const Camera direction = NamedCameraAt(name, {});
      const ViewPlace place = PlaceFor(NeededHull(state, direction), direction, kWide);
      const Camera camera = MovedTo(place, direction, GroundExtentOf(state).middle);
      double top = 1, bottom = 0, left = 1, right = 0;
      for (const Ball& ball : BallsOf(state.people[0])) {
        const Projected at = Project(ball.center, camera, 1280, 720);
        const double radius = at.px_per_m * ball.radius;
        top = std::min(top, (at.y_px - radius) / 720);
        bottom = std::max(bottom, (at.y_px + radius) / 720);
        left = std::min(left, (at.x_px - radius) / 1280);
        right = std::max(right, (at.x_px + radius) / 1280);
      }
      // From above, the head is much nearer than the rest.
      const double least = std::string(name) == "top" ? 0.4 : 0.6;
      EXPECT_GT(std::max(bottom - top, right - left), least) << name;
      EXPECT_GT(std::min(top, left), 0.09) << name;
      EXPECT_LT(std::max(bottom, right), 0.91) << name;
    }
  }
}

TEST(NeededHull, IsThatOfAnAdultWithArmsOverheadWithoutPeople) {
  EXPECT_NEAR(HeightFor(NeededHull(SceneState(), Level())), kGroupFraming.height_m, 0.2);
}

TEST(NeededHull, LeavesOutWhatIsFarFromItsPerson) {
  SceneState state = BodyAlone();
  const double alone = HeightFor(NeededHull(state, Level()));
  state.people[0].props[0].emplace().pose.position = {0, 70, 1};
  EXPECT_EQ(HeightFor(NeededHull(state, Level())), alone);
  state.people[0].props[0]->pose.position = {0, 0, 2.3};
  EXPECT_GT(HeightFor(NeededHull(state, Level())), alone) << "one that is held counts";
}

}  // namespace
}  // namespace kinescope::render
