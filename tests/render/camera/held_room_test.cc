#include "render/camera/held_room.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/person_outline.h"
#include "render/camera/camera.h"
#include "tests/render/test_scene.h"

namespace kinescope::render {
namespace {

using kinescope::testing::BodyAlone;
using kinescope::testing::Posture;

constexpr ViewRoom kStanding{2.4, 0.1}, kSitting{1.5, 0.3}, kOverhead{3, 0.1};

// What is shown after `secs` more seconds in which `needed` is constant.
class Take {
 public:
  double Play(const ViewRoom& needed, double secs) {
    const double end = secs_ + secs;
    for (; secs_ < end; secs_ += 1.0 / 30) {
      const double before = shown_.height;
      shown_ = held_.Follow(needed, secs_);
      if (before > 0) {
        EXPECT_LT(std::abs(shown_.height - before), 0.08) << "jumps at " << secs_;
        moved_ += std::abs(shown_.height - before) > 0.0005 ? 1 : 0;
      }
    }
    return shown_.height;
  }
  double below() const { return shown_.below; }
  int moved() const { return moved_; }

 private:
  HeldRoom held_;
  double secs_ = 0;
  ViewRoom shown_;
  int moved_ = 0;
};

TEST(HeldRoom, ComesNearerSlowlyAfterTwoSecondsAndMakesRoomAtOnce) {
  Take take;
  take.Play(kStanding, 5);
  EXPECT_EQ(take.Play(kSitting, 1.8), kStanding.height);
  EXPECT_NEAR(take.below(), kSitting.below, 0.02) << "nothing is cut off";
  EXPECT_GT(take.Play(kSitting, 1), 0.75 * kStanding.height);
  EXPECT_NEAR(take.Play(kSitting, 3), kSitting.height, 0.05);
  EXPECT_GT(take.Play(kOverhead, 0.6), 0.85 * kOverhead.height);
  EXPECT_NEAR(take.Play(kOverhead, 2), kOverhead.height, 0.02);
}

TEST(HeldRoom, LearnsToStandStillForWhoBendsAndRisesAgain) {
  Take take;
  for (int i = 0; i < 3; ++i) {
    take.Play(kStanding, 3);
    take.Play(kSitting, 4);
  }
  const int learnt = take.moved();
  for (int i = 0; i < 10; ++i) {
    EXPECT_GE(take.Play(kStanding, 3), 0.85 * kStanding.height);
    take.Play(kSitting, 4);
  }
  EXPECT_LT(take.moved(), learnt + 60) << "pictures in which it zooms";
  take.Play(kSitting, 30);
  take.Play(kStanding, 30);
  EXPECT_NEAR(take.Play(kSitting, 6), kSitting.height, 0.05) << "it waits two seconds again";
}

TEST(HeldRoom, IgnoresSmallDifferences) {
  Take take;
  take.Play(kStanding, 2);
  EXPECT_EQ(take.Play({1.1 * kStanding.height, 0.15}, 5), kStanding.height);
  EXPECT_EQ(take.Play({0.9 * kStanding.height, 0}, 30), kStanding.height);
  EXPECT_EQ(take.moved(), 0);
}

TEST(HeldRoom, BeginsAnewWhereTimeGoesBack) {
  HeldRoom held;
  held.Follow(kOverhead, 100);
  EXPECT_EQ(held.Follow(kSitting, 3).height, kSitting.height);
}

TEST(NeededRoom, LetsEveryPostureFillMostOfTheView) {
  for (const Posture posture : {Posture::kStanding, Posture::kDeepBend, Posture::kArmsForward}) {
    const SceneState state = BodyAlone(posture);
    GroundExtent ground = GroundExtentOf(state);
    ground.height = NeededRoom(state).height;
    ground.below = NeededRoom(state).below;
    for (const char* name : {"front", "left", "three_quarter"}) {
      const Camera camera = NamedCameraAt(name, ground);
      double top = 1, bottom = 0;
      for (const Ball& ball : BallsOf(state.people[0])) {
        const Projected at = Project(ball.center, camera, 1280, 720);
        top = std::min(top, (at.y_px - at.px_per_m * ball.radius) / 720);
        bottom = std::max(bottom, (at.y_px + at.px_per_m * ball.radius) / 720);
      }
      EXPECT_GT(top, 0.03) << name;
      EXPECT_LT(bottom, 1) << name;
      constexpr double kFree = 0.93;  // below the title
      EXPECT_LT((bottom - top) / kFree, 0.95) << name;
      EXPECT_GT((bottom - top) / kFree, 0.6) << name;
    }
  }
  EXPECT_EQ(NeededRoom(SceneState()).height, kGroupFraming.height_m);
}

}  // namespace
}  // namespace kinescope::render
