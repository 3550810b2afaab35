// What the floor does: required by the motion, or measured, in their order of precedence.
#include "server/loads/ground_reaction.h"

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
  GroundReaction Solve(const GroundSensors& sensors = {}, bool clamp_cop = true) const {
    return SolveGroundReaction({links, demand, hands, contacts, 0, kStandingMassKg, clamp_cop},
                               sensors);
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

double ResidualOf(const GroundReaction& ground) {
  return ground.joints[kPelvis].force.norm() + ground.joints[kPelvis].moment.norm();
}

TEST(GroundReaction, CarriesTheWeightBelowTheCentreOfMass) {
  const Stance stance(Posed({}));
  const GroundReaction ground = stance.Solve();
  EXPECT_EQ(ground.why_not, "");
  EXPECT_FALSE(ground.is_measured);
  EXPECT_NEAR((ground.force - Vector3d(0, 0, kStandingWeight)).norm(), 0, 1e-6);
  ASSERT_TRUE(ground.cop);
  const Vector3d com = CenterOfMassOf(stance.demand, Body());
  EXPECT_NEAR((ground.cop->point - com.head<2>()).norm(), 0, 1e-9);
  EXPECT_NEAR(ground.feet[kRight].force.z(), kStandingWeight / 2, 1e-6);
  EXPECT_GT(ground.cop_inside, 0);
  EXPECT_LT(ResidualOf(ground), 1e-6) << "nothing is left unexplained";
}

TEST(GroundReaction, CarriesAHandLoadToo) {
  Stance stance(Posed({}));
  stance.hands.Push(stance.links, kRightHand, {0, 0, -100},
                    stance.links[urdf::At(kRightHand)].position);
  const GroundReaction ground = stance.Solve();
  EXPECT_NEAR(ground.force.z(), kStandingWeight + 100, 1e-6);
  EXPECT_LT(ground.cop->point.y(), Stance(Posed({})).Solve().cop->point.y())
      << "further to the right";
}

TEST(GroundReaction, IsUnknownInTheFlightPhase) {
  BodyMotion falling{};
  for (SegmentMotion& segment : falling) segment.acceleration = {0, 0, -kGravity};
  const GroundReaction ground = Stance(Posed({}), falling).Solve();
  EXPECT_EQ(ground.why_not, "no ground reaction force (flight phase)");
  EXPECT_EQ(ground.force, Vector3d::Zero());
  EXPECT_FALSE(ground.cop);
  EXPECT_TRUE(std::isnan(ground.cop_inside));
}

TEST(GroundReaction, IsUnknownWithoutFootContact) {
  LinkPoses sitting = Posed({}, {0, 0, 1.5});  // half a metre up, at rest
  const GroundReaction ground = Stance(sitting).Solve();
  EXPECT_EQ(ground.why_not, "no foot contact");
  EXPECT_EQ(ground.force, Vector3d::Zero());
  EXPECT_FALSE(ground.cop);
}

TEST(GroundReaction, ShowsACentreOfPressureOutsideTheFeetAtTheirBorder) {
  Stance stance(Posed({}));
  stance.hands.Push(stance.links, kRightHand, {0, 0, -300}, {1, 0, 1});  // a metre ahead
  const GroundReaction ground = stance.Solve();
  ASSERT_TRUE(ground.cop);
  EXPECT_LT(ground.cop_inside, -0.01);
  EXPECT_NE(ground.shown_cop, ground.cop->point);
  EXPECT_NEAR(DistanceInside(stance.contacts.support(), ground.shown_cop), 0, 1e-9);
  for (const Side side : {kRight, kLeft}) {
    EXPECT_GE(DistanceInside(stance.contacts.polygon(side), ground.feet[side].point), -1e-9);
  }
  const GroundReaction unclamped = stance.Solve({}, false);
  EXPECT_EQ(unclamped.shown_cop, unclamped.cop->point);
  EXPECT_NEAR(unclamped.cop_inside, ground.cop_inside, 1e-12);
  EXPECT_LT(ResidualOf(unclamped), 1e-6);
  EXPECT_GT(ResidualOf(ground), 1) << "which a clamped one cannot explain";
}

TEST(GroundReaction, PrefersMeasurementsOfBothFeet) {
  const Stance stance(Posed({}));
  const auto right = MeasuredAt({10, 5, 500}, {0.1, -0.08, 0}, 2);
  const auto left = MeasuredAt({-10, 0, 250}, {0.05, 0.09, 0}, -1);
  const auto total = MeasuredAt({0, 0, 999}, {0, 0, 0});
  GroundSensors sensors;
  sensors.feet = {&right, &left};
  sensors.total = &total;
  const GroundReaction ground = stance.Solve(sensors);
  EXPECT_TRUE(ground.is_measured);
  EXPECT_NEAR((ground.force - Vector3d(0, 5, 750)).norm(), 0, 1e-9);
  EXPECT_EQ(ground.feet[kRight].force, right.force);
  EXPECT_EQ(ground.feet[kLeft].point, Vector2d(0.05, 0.09));
  ASSERT_TRUE(ground.cop);
  EXPECT_NEAR((ground.cop->point - Vector2d(0.25 / 3, -0.07 / 3)).norm(), 0, 1e-9)
      << "between them by their vertical forces";
  // About the common point: both free moments, and what the horizontal parts turn.
  double moment = 0;
  for (const auto* foot : {&right, &left}) {
    const Vector2d arm = foot->point.head<2>() - ground.cop->point;
    moment += foot->free_moment + arm.x() * foot->force.y() - arm.y() * foot->force.x();
  }
  EXPECT_NEAR(ground.cop->free_moment, moment, 1e-9);
}

TEST(GroundReaction, IgnoresTheMeasurementOfASingleFoot) {
  const auto right = MeasuredAt({0, 0, 500}, {0.1, -0.08, 0});
  GroundSensors sensors;
  sensors.feet[kRight] = &right;
  const GroundReaction ground = Stance(Posed({})).Solve(sensors);
  EXPECT_FALSE(ground.is_measured);
  EXPECT_NEAR(ground.force.z(), kStandingWeight, 1e-6);
}

TEST(GroundReaction, ReportsFlightIfBothMeasuredForcesAreZero) {
  const auto nothing = MeasuredAt(Vector3d::Zero(), Vector3d::Zero());
  GroundSensors sensors;
  sensors.feet = {&nothing, &nothing};
  const GroundReaction ground = Stance(Posed({})).Solve(sensors);
  EXPECT_EQ(ground.why_not, "no ground reaction force (flight phase)");
  EXPECT_FALSE(ground.cop);
}

TEST(GroundReaction, UsesTheMeasuredComponentsOfATotalForce) {
  const Stance stance(Squat());
  auto total = MeasuredAt({30, -20, 700}, {0.06, 0.01, 0}, 3);
  GroundSensors sensors;
  sensors.total = &total;
  const GroundReaction whole = stance.Solve(sensors);
  EXPECT_TRUE(whole.is_measured);
  EXPECT_EQ(whole.force, total.force);
  EXPECT_EQ(whole.cop->point, Vector2d(0.06, 0.01));
  EXPECT_EQ(whole.cop->free_moment, 3);

  total.only_vertical = true;
  const GroundReaction vertical = stance.Solve(sensors);
  EXPECT_NEAR((vertical.force - Vector3d(0, 0, 700)).norm(), 0, 1e-9)
      << "somebody at rest pushes straight down";

  total.only_vertical = false;
  total.only_point = true;
  const GroundReaction point = stance.Solve(sensors);
  EXPECT_NEAR((point.force - Vector3d(0, 0, kStandingWeight)).norm(), 0, 1e-6)
      << "as the motion has it";
  EXPECT_EQ(point.cop->point, Vector2d(0.06, 0.01));
}

}  // namespace
}  // namespace kinescope::loads::testing
