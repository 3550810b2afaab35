#include "render/camera/held_extent.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "render/camera/held_view.h"
#include "tests/render/test_scene.h"

namespace kinescope::render {
namespace {

using Eigen::Vector3d;

constexpr double kAspect = 16.0 / 9;
constexpr double kPicturesPerSecond = 30;  // per second

SceneState PeopleAt(const std::vector<Vector3d>& places) {
  static const SceneState standing = testing::SceneWith(testing::Posture::kStanding);
  SceneState state;
  const PersonState& person = standing.people[0];
  const Vector3d pelvis = person.links[urdf::kPelvis].position;
  for (const Vector3d& place : places) {
    state.people.push_back(person);
    for (urdf::Pose& link : state.people.back().links) {
      link.position += place - Vector3d(pelvis.x(), pelvis.y(), 0);
    }
  }
  return state;
}

// One or several people whose places are functions of the time.
class Take {
 public:
  explicit Take(std::function<std::vector<Vector3d>(double)> places) : places_(std::move(places)) {}

  // Pictures until `secs`, in each of which all must be seen.
  void PlayUntil(double secs) {
    for (; secs_ <= secs; secs_ += 1 / kPicturesPerSecond) {
      const std::vector<Vector3d> places = places_(secs_);
      const GroundExtent before = aimed_;
      const SceneState people = PeopleAt(places);
      const double width = 2 * (GroundExtentOf(people).radius + kGroupFraming.margin_m);
      ShownRoom room;
      room.height = std::max(room.height, width / kAspect);
      aimed_ = held_.Follow(people, secs_, kAspect, room);
      if (pictures_++ == 0) continue;
      const double step = (aimed_.middle - before.middle).norm();
      moved_ += step > 0 || aimed_.radius != before.radius ? 1 : 0;
      EXPECT_LT(std::abs(step - last_step_), 0.03) << "jerks at " << secs_ << " s";
      last_step_ = step;
      const Camera camera =
          MovedTo({0, 1, held_.height()}, NamedCameraAt("front", {}), aimed_.middle);
      for (const Vector3d& place : places) {
        const double x = Project(place + Vector3d(0, 0, 1), camera, 1280, 720).x_px;
        EXPECT_GT(x, 0.06 * 1280) << "at " << secs_ << " s";
        EXPECT_LT(x, 0.94 * 1280) << "at " << secs_ << " s";
      }
    }
  }
  int pictures_that_moved() { return std::exchange(moved_, 0); }
  const GroundExtent& aimed() const { return aimed_; }

 private:
  std::function<std::vector<Vector3d>(double)> places_;
  HeldGroundExtent held_;
  GroundExtent aimed_;
  double secs_ = 0, last_step_ = 0;
  int pictures_ = 0, moved_ = 0;
};

Vector3d OnCircle(double radius, double secs) {
  const double angle = 1.2 * secs / radius;
  return {radius * std::sin(angle), -radius * std::cos(angle), 0};
}

TEST(HeldGroundExtent, StandsStillWhilePeopleStayInThePicture) {
  Take take([](double secs) {
    return std::vector<Vector3d>{{0.4 * std::sin(secs), 0.9 * std::sin(0.7 * secs), 0}};
  });
  take.PlayUntil(60);
  EXPECT_EQ(take.pictures_that_moved(), 0);
}

TEST(HeldGroundExtent, StandsStillAfterOneLapOfACircle) {
  Take take([](double secs) { return std::vector<Vector3d>{OnCircle(1.5, secs)}; });
  take.PlayUntil(20);
  EXPECT_GT(take.pictures_that_moved(), 0) << "it finds the middle first";
  take.PlayUntil(120);
  EXPECT_EQ(take.pictures_that_moved(), 0);
  EXPECT_LT(take.aimed().middle.norm(), 0.3);
}

TEST(HeldGroundExtent, StandsStillBeforeAGroupThatWalksInCircles) {
  Take take([](double secs) {
    std::vector<Vector3d> places;
    for (int i = 0; i < 4; ++i) places.push_back(OnCircle(1.5, secs) + Vector3d(0, 1.5 * i, 0));
    return places;
  });
  take.PlayUntil(20);
  take.pictures_that_moved();
  take.PlayUntil(120);
  EXPECT_EQ(take.pictures_that_moved(), 0);
}

TEST(HeldGroundExtent, FollowsAPersonWhoWalksOn) {
  Take take([](double secs) { return std::vector<Vector3d>{{0, 1.3 * secs, 0}}; });
  take.PlayUntil(60);
  EXPECT_GT(take.pictures_that_moved(), 55 * kPicturesPerSecond);
  EXPECT_NEAR(take.aimed().middle.y(), 1.3 * 60, 1.2);
}

TEST(HeldGroundExtent, ComesNearerWhenAGroupHasDrawnTogether) {
  Take take([](double secs) {
    const double apart = 1 + 4 * std::max(0.0, 1 - secs / 5);
    return std::vector<Vector3d>{{0, -apart, 0}, {0, apart, 0}};
  });
  take.PlayUntil(1);
  EXPECT_GT(take.aimed().radius, 4);
  take.PlayUntil(30);
  EXPECT_LT(take.aimed().radius, 1.6);
}

TEST(HeldGroundExtent, GlidesEquallyFarWithMoreAndFewerPictures) {
  const auto y_after = [](double step) {
    HeldGroundExtent held;
    for (int i = 0; i < 10; ++i) held.Follow(PeopleAt({{0, 0, 0}}), 0.1 * i, kAspect);
    double y = 0;
    for (double secs = 1; secs < 3.01; secs += step) {
      y = held.Follow(PeopleAt({{0, 9, 0}}), secs, kAspect).middle.y();
    }
    return y;
  };
  EXPECT_NEAR(y_after(0.1), y_after(0.02), 0.15);
}

TEST(HeldGroundExtent, StartsAnewWhereTimeGoesBackAndWaitsForPeople) {
  HeldGroundExtent held;
  EXPECT_EQ(held.Follow(SceneState(), 0, kAspect).middle, Vector3d::Zero());
  EXPECT_EQ(held.Follow(PeopleAt({{3, 4, 0}}), 50, kAspect).middle, Vector3d(3, 4, 0))
      << "the first person sets it at once";
  EXPECT_EQ(held.Follow(SceneState(), 51, kAspect).middle, Vector3d(3, 4, 0));
  EXPECT_EQ(held.Follow(PeopleAt({{3, 4.5, 0}}), 1, kAspect).middle, Vector3d(3, 4, 0));
  EXPECT_EQ(held.Follow(PeopleAt({{3, 4.5, 0}}), 2, kAspect).middle, Vector3d(3, 4, 0));
}

}  // namespace
}  // namespace kinescope::render
