#include "render/camera/held_height.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/person_outline.h"
#include "render/camera/camera.h"
#include "tests/render/test_scene.h"

namespace kinescope::render {
namespace {

using kinescope::testing::BodyAlone;
using kinescope::testing::Posture;

constexpr double kStanding = 2.4, kSitting = 1.5, kOverhead = 3;

// The shown height after `secs` more seconds in which `needed` is constant.
class Take {
 public:
  double Play(double needed, double secs) {
    const double end = secs_ + secs;
    for (; secs_ < end; secs_ += 1.0 / 30) {
      const double before = shown_;
      shown_ = held_.Follow(needed, secs_);
      if (before > 0) {
        EXPECT_LT(std::abs(shown_ - before), 0.08) << "jumps at " << secs_;
        moved_ += shown_ != before ? 1 : 0;
      }
    }
    return shown_;
  }
  int moved() const { return moved_; }

 private:
  HeldHeight held_;
  double secs_ = 0, shown_ = 0;
  int moved_ = 0;
};

TEST(HeldHeight, StandsStillForWhoBendsAndRisesAgain) {
  Take take;
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(take.Play(kStanding, 3), kStanding);
    EXPECT_EQ(take.Play(kSitting, 3), kStanding);
  }
  EXPECT_EQ(take.moved(), 0);
}

TEST(HeldHeight, MakesRoomAtOnceAndComesNearerAfterSomeTime) {
  Take take;
  take.Play(kStanding, 2);
  EXPECT_NEAR(take.Play(kOverhead, 2), kOverhead, 0.02);
  EXPECT_NEAR(take.Play(kSitting, 8), kOverhead, 0.02) << "still remembered";
  EXPECT_NEAR(take.Play(kSitting, 12), kSitting, 0.02);
}

TEST(HeldHeight, IgnoresSmallDifferences) {
  Take take;
  take.Play(kStanding, 2);
  EXPECT_EQ(take.Play(1.1 * kStanding, 5), kStanding);
  EXPECT_EQ(take.Play(0.85 * kStanding, 30), kStanding);
}

TEST(HeldHeight, BeginsAnewWhereTimeGoesBack) {
  HeldHeight held;
  held.Follow(kOverhead, 100);
  EXPECT_EQ(held.Follow(kSitting, 3), kSitting);
}

TEST(NeededHeight, LetsEveryPostureFillMostOfTheView) {
  for (const Posture posture : {Posture::kStanding, Posture::kDeepBend, Posture::kArmsForward}) {
    const SceneState state = BodyAlone(posture);
    GroundExtent ground = GroundExtentOf(state);
    ground.height = NeededHeight(state);
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
      if (posture != Posture::kArmsForward) {
        EXPECT_GT((bottom - top) / kFree, 0.6) << name;
      }
    }
  }
  EXPECT_EQ(NeededHeight(SceneState()), kGroupFraming.height_m);
}

}  // namespace
}  // namespace kinescope::render
