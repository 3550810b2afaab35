#include "server/scene/held_heading.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "urdf/heading.h"
#include "urdf/skeleton.h"

namespace kinescope::app {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kPicturePeriod = 1.0 / 60;  // s
constexpr double kDegree = M_PI / 180;

Quaterniond Turn(double degrees, const Vector3d& axis) {
  return Quaterniond(Eigen::AngleAxisd(degrees * kDegree, axis));
}
Quaterniond Facing(double degrees) { return Turn(degrees, Vector3d::UnitZ()); }
// On the back, the head towards `degrees`.
Quaterniond Lying(double degrees) { return Facing(degrees + 180) * Turn(-90, Vector3d::UnitY()); }
Quaterniond UpsideDown() { return Turn(180, Vector3d::UnitY()); }

urdf::LinkPoses LinksOf(const Quaterniond& pelvis, const Vector3d& place = {0, 0, 1}) {
  return urdf::ForwardKinematics(urdf::DefaultSkeleton(), {place, pelvis}, {});
}

class Shown {
 public:
  explicit Shown(CameraFrame frame) : heading_(frame) {}

  // After a sample, degrees.
  double At(double secs, const Quaterniond& pelvis, const Vector3d& place = {0, 0, 1}) {
    person_.links = LinksOf(pelvis, place);
    last_ = pelvis;
    person_.sample.stamp_nanos = 1'700'000'000'000'000'000 + std::llround(1e9 * secs);
    person_.sample.counter += 1;
    return heading_.Follow(person_) / kDegree;
  }
  // After `more` seconds.
  double Play(double more, const std::function<Quaterniond(double secs)>& pelvis) {
    double shown = At(secs_, pelvis(secs_));
    for (const double end = secs_ + more; secs_ < end; secs_ += kPicturePeriod) {
      const double before = shown;
      shown = At(secs_, pelvis(secs_));
      fastest_ = std::max(fastest_, std::abs(std::remainder(shown - before, 360)) / kPicturePeriod);
    }
    return shown;
  }
  double Play(double more, const Quaterniond& pelvis) {
    return Play(more, [&](double) { return pelvis; });
  }
  // Half a second on the way to `pelvis`, then there.
  double Go(const Quaterniond& pelvis, double more) {
    const double begin = secs_;
    const Quaterniond from = last_;
    return Play(more,
                [&](double secs) { return from.slerp(std::min(1.0, 2 * (secs - begin)), pelvis); });
  }
  double fastest() const { return fastest_; }  // that the view has turned, degrees per second
  PersonState& person() { return person_; }

 private:
  PersonState person_;
  HeldHeading heading_;
  Quaterniond last_ = Quaterniond::Identity();
  double secs_ = 0, fastest_ = 0;
};

TEST(HeldHeading, IsThatOfTheBeginningAndStays) {
  Shown shown(CameraFrame::kStart);
  EXPECT_NEAR(shown.At(0, Facing(180)), 180, 1e-9);
  EXPECT_NEAR(shown.Play(5, [](double secs) { return Facing(180 + 90 * secs); }), 180, 1e-9)
      << "who turns";
  EXPECT_NEAR(shown.Go(Lying(20), 5), 180, 1e-9) << "or lies";
  Shown nearly(CameraFrame::kStart);
  EXPECT_NEAR(nearly.At(0, Facing(-84)), -90, 1e-9) << "along the floor's lines";
  Shown world(CameraFrame::kWorld);
  EXPECT_EQ(world.At(0, Facing(180)), 0);
}

TEST(HeldHeading, IsTakenWhenThePersonHasStoodUp) {
  Shown shown(CameraFrame::kStart);
  EXPECT_NEAR(shown.Play(2, Lying(140)), *urdf::HeadingOf(LinksOf(Lying(140))).rad / kDegree, 1e-6);
  EXPECT_GT(std::abs(shown.Go(Facing(-40), 1) + 40), 10) << "it glides";
  EXPECT_NEAR(shown.Go(Facing(-40), 9), -40, 1e-6);
  EXPECT_LT(shown.fastest(), 120);
  EXPECT_NEAR(shown.Go(Facing(80), 4), -40, 1e-6);
}

TEST(HeldHeading, KeepsTheLastOneWhereItIsUndefined) {
  Shown shown(CameraFrame::kStart);
  EXPECT_NEAR(shown.Play(1, UpsideDown()), 0, 1e-9) << "the world's";
  EXPECT_NEAR(shown.Go(Facing(70), 9), 70, 3);
  Shown turning(CameraFrame::kPerson);
  turning.Play(1, Facing(70));
  turning.At(1 + kPicturePeriod, Facing(70) * UpsideDown());
  EXPECT_NEAR(turning.At(2, Facing(70) * UpsideDown()), 70, 1e-6);
}

TEST(HeldHeading, IsTakenAgainAtOnceWhereTheMotionIsNotContinued) {
  Shown reset(CameraFrame::kStart);
  reset.Play(1, Facing(0));
  EXPECT_NEAR(reset.At(1, Facing(60)), 60, 1e-9) << "the character was reset";
  EXPECT_NEAR(reset.At(1 + kPicturePeriod, Facing(60), {3, 0, 1}), 60, 1e-9);
  EXPECT_NEAR(reset.At(1 + 2 * kPicturePeriod, Facing(90), {6, 0, 1}), 90, 1e-9) << "put elsewhere";
  EXPECT_NEAR(reset.At(0.5, Facing(100), {6, 0, 1}), 100, 1e-9) << "time goes back";
  reset.person().sample.counter = 0;
  EXPECT_NEAR(reset.At(0.6, Facing(75), {6, 0, 1}), 75, 1e-9) << "the sender was restarted";
  EXPECT_NEAR(reset.At(2, Facing(30), {6, 0, 1}), 75, 1e-9) << "a gap";
  EXPECT_NEAR(reset.At(30, Facing(30), {6, 0, 1}), 30, 1e-9) << "a long one";
  reset.person().character = 7;
  EXPECT_NEAR(reset.At(30.1, Facing(150), {-6, 0, 1}), 30, 1e-9) << "another is now the first";
}

TEST(HeldHeading, TurnsSlowlyWithThePersonAndThenStands) {
  Shown shown(CameraFrame::kPerson);
  const auto walk_to = [](double degrees) {
    return [=](double secs) { return Facing(degrees + 8 * std::sin(6 * secs)); };
  };
  EXPECT_NEAR(shown.Play(3, walk_to(30)), 30, 8);
  EXPECT_LT(shown.fastest(), 1e-9) << "a walking pelvis does not turn it";
  EXPECT_NEAR(shown.Go(Facing(160), 0.5), 30, 25) << "not at once";
  const double arrived = shown.Play(9, walk_to(160));
  EXPECT_NEAR(arrived, 160, 6);
  EXPECT_LT(shown.fastest(), 100);
  EXPECT_EQ(shown.Play(5, walk_to(160)), arrived) << "it does not hunt";
}

TEST(HeldHeading, IsCalmWhileThePersonSpinsOrRolls) {
  for (const double speed : {40.0, 100.0, 360.0, 700.0}) {
    Shown shown(CameraFrame::kPerson);
    shown.Play(1, Facing(0));
    shown.Play(10, [&](double secs) { return Facing(speed * (secs - 1)); });
    EXPECT_LT(shown.fastest(), 80) << speed;
  }
  for (const CameraFrame frame : {CameraFrame::kStart, CameraFrame::kPerson}) {
    Shown shown(frame);
    shown.Play(1, Facing(20));
    shown.Go(Facing(20) * Turn(90, Vector3d::UnitY()), 1);
    shown.Play(10, [](double secs) {
      return Facing(20) * Turn(90, Vector3d::UnitY()) * Turn(200 * (secs - 2), Vector3d::UnitZ());
    });
    EXPECT_LT(shown.fastest(), frame == CameraFrame::kStart ? 1e-9 : 120);
  }
}

}  // namespace
}  // namespace kinescope::app
