// What the floor does: required by the motion, or measured, in their order of precedence.
#include "server/loads/standing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "server/loads/support_polygon.h"
#include "tests/server/loads/loads_testing.h"

namespace kinescope::loads::testing {
namespace {

constexpr double kStandingMassKg = 75;
constexpr double kStandingWeight = kStandingMassKg * kGravity;

// Somebody in `links`, without motion.
struct Stance {
  explicit Stance(const LinkPoses& posed, const BodyMotion& motion = {})
      : links(posed), demand(DemandOf(links, motion, Body())) {
    contacts.Update(SampleOf(links), links, Person(), 0, {});
  }
  Standing Solve(const GroundSensors& sensors = {}, bool clamp_cop = true) const {
    return SolveStanding({links, demand, hands, contacts, 0, kStandingMassKg, clamp_cop}, sensors);
  }

  LinkPoses links;
  BodyDemand demand;
  ExternalForces hands;
  FootContacts contacts;
};

MeasuredGroundForce MeasuredAt(const Vector3d& force, const Vector3d& point,
                               double free_moment = 0) {
  MeasuredGroundForce measured;
  measured.force = force;
  measured.point = point;
  measured.free_moment = free_moment;
  return measured;
}

double ResidualOf(const Standing& standing) {
  return standing.joints[kPelvis].force.norm() + standing.joints[kPelvis].moment.norm();
}

TEST(Standing, TheFloorCarriesTheWeightBelowTheCentreOfMass) {
  const Stance stance(Posed({}));
  const Standing standing = stance.Solve();
  EXPECT_EQ(standing.why_not, "");
  EXPECT_FALSE(standing.is_measured);
  EXPECT_NEAR((standing.force - Vector3d(0, 0, kStandingWeight)).norm(), 0, 1e-6);
  ASSERT_TRUE(standing.cop);
  const Vector3d com = CenterOfMassOf(stance.demand, Body());
  EXPECT_NEAR((standing.cop->point - com.head<2>()).norm(), 0, 1e-9);
  EXPECT_NEAR(standing.feet[kRight].force.z(), kStandingWeight / 2, 1e-6);
  EXPECT_GT(standing.cop_inside, 0);
  EXPECT_LT(ResidualOf(standing), 1e-6) << "nothing is left unexplained";
}

TEST(Standing, ALoadInTheHandsIsCarriedAsWell) {
  Stance stance(Posed({}));
  stance.hands.Push(stance.links, kRightHand, {0, 0, -100},
                    stance.links[urdf::At(kRightHand)].position);
  const Standing standing = stance.Solve();
  EXPECT_NEAR(standing.force.z(), kStandingWeight + 100, 1e-6);
  EXPECT_LT(standing.cop->point.y(), Stance(Posed({})).Solve().cop->point.y())
      << "further to the right";
}

TEST(Standing, InFlightNothingIsSaidAboutTheFloor) {
  BodyMotion falling{};
  for (SegmentMotion& segment : falling) segment.acceleration = {0, 0, -kGravity};
  const Standing standing = Stance(Posed({}), falling).Solve();
  EXPECT_EQ(standing.why_not, "no ground reaction force (flight phase)");
  EXPECT_EQ(standing.force, Vector3d::Zero());
  EXPECT_FALSE(standing.cop);
  EXPECT_TRUE(std::isnan(standing.cop_inside));
}

TEST(Standing, WithoutAFootOnTheFloorSomethingElseCarries) {
  LinkPoses sitting = Posed({}, {0, 0, 1.5});  // half a metre up, at rest
  const Standing standing = Stance(sitting).Solve();
  EXPECT_EQ(standing.why_not, "no foot contact");
  EXPECT_EQ(standing.force, Vector3d::Zero());
  EXPECT_FALSE(standing.cop);
}

TEST(Standing, ACentreOfPressureOutsideTheFeetIsToldAndShownAtTheirBorder) {
  Stance stance(Posed({}));
  stance.hands.Push(stance.links, kRightHand, {0, 0, -300}, {1, 0, 1});  // a metre ahead
  const Standing standing = stance.Solve();
  ASSERT_TRUE(standing.cop);
  EXPECT_LT(standing.cop_inside, -0.01);
  EXPECT_NE(standing.shown_cop, standing.cop->point);
  EXPECT_NEAR(DistanceInside(stance.contacts.support(), standing.shown_cop), 0, 1e-9);
  for (const Side side : {kRight, kLeft}) {
    EXPECT_GE(DistanceInside(stance.contacts.polygon(side), standing.feet[side].point), -1e-9);
  }
  const Standing unclamped = stance.Solve({}, false);
  EXPECT_EQ(unclamped.shown_cop, unclamped.cop->point);
  EXPECT_NEAR(unclamped.cop_inside, standing.cop_inside, 1e-12);
  EXPECT_LT(ResidualOf(unclamped), 1e-6);
  EXPECT_GT(ResidualOf(standing), 1) << "which a clamped one cannot explain";
}

TEST(Standing, BothFeetMeasuredComeBeforeAllElse) {
  const Stance stance(Posed({}));
  const auto right = MeasuredAt({10, 5, 500}, {0.1, -0.08, 0}, 2);
  const auto left = MeasuredAt({-10, 0, 250}, {0.05, 0.09, 0}, -1);
  const auto total = MeasuredAt({0, 0, 999}, {0, 0, 0});
  GroundSensors sensors;
  sensors.feet = {&right, &left};
  sensors.total = &total;
  const Standing standing = stance.Solve(sensors);
  EXPECT_TRUE(standing.is_measured);
  EXPECT_NEAR((standing.force - Vector3d(0, 5, 750)).norm(), 0, 1e-9);
  EXPECT_EQ(standing.feet[kRight].force, right.force);
  EXPECT_EQ(standing.feet[kLeft].point, Vector2d(0.05, 0.09));
  ASSERT_TRUE(standing.cop);
  EXPECT_NEAR((standing.cop->point - Vector2d(0.25 / 3, -0.07 / 3)).norm(), 0, 1e-9)
      << "between them by their vertical forces";
  // About the common point: both free moments, and what the horizontal parts turn.
  double moment = 0;
  for (const auto* foot : {&right, &left}) {
    const Vector2d arm = foot->point.head<2>() - standing.cop->point;
    moment += foot->free_moment + arm.x() * foot->force.y() - arm.y() * foot->force.x();
  }
  EXPECT_NEAR(standing.cop->free_moment, moment, 1e-9);
}

TEST(Standing, OneMeasuredFootAloneDoesNotCount) {
  const auto right = MeasuredAt({0, 0, 500}, {0.1, -0.08, 0});
  GroundSensors sensors;
  sensors.feet[kRight] = &right;
  const Standing standing = Stance(Posed({})).Solve(sensors);
  EXPECT_FALSE(standing.is_measured);
  EXPECT_NEAR(standing.force.z(), kStandingWeight, 1e-6);
}

TEST(Standing, MeasuredFeetInTheAirAreInTheAir) {
  const auto nothing = MeasuredAt(Vector3d::Zero(), Vector3d::Zero());
  GroundSensors sensors;
  sensors.feet = {&nothing, &nothing};
  const Standing standing = Stance(Posed({})).Solve(sensors);
  EXPECT_EQ(standing.why_not, "no ground reaction force (flight phase)");
  EXPECT_FALSE(standing.cop);
}

TEST(Standing, ATotalForceIsTakenAsFarAsItIsMeasured) {
  const Stance stance(Squat());
  auto total = MeasuredAt({30, -20, 700}, {0.06, 0.01, 0}, 3);
  GroundSensors sensors;
  sensors.total = &total;
  const Standing whole = stance.Solve(sensors);
  EXPECT_TRUE(whole.is_measured);
  EXPECT_EQ(whole.force, total.force);
  EXPECT_EQ(whole.cop->point, Vector2d(0.06, 0.01));
  EXPECT_EQ(whole.cop->free_moment, 3);

  total.only_vertical = true;
  const Standing vertical = stance.Solve(sensors);
  EXPECT_NEAR((vertical.force - Vector3d(0, 0, 700)).norm(), 0, 1e-9)
      << "somebody at rest pushes straight down";

  total.only_vertical = false;
  total.only_point = true;
  const Standing point = stance.Solve(sensors);
  EXPECT_NEAR((point.force - Vector3d(0, 0, kStandingWeight)).norm(), 0, 1e-6)
      << "as the motion has it";
  EXPECT_EQ(point.cop->point, Vector2d(0.06, 0.01));
}

}  // namespace
}  // namespace kinescope::loads::testing
