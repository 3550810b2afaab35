#include "urdf/heading.h"

#include <gtest/gtest.h>

#include <cmath>

#include "urdf/skeleton.h"

namespace kinescope::urdf {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kDegree = 3.14159265358979323846 / 180;

Quaterniond Turn(double degrees, const Vector3d& axis) {
  return Quaterniond(Eigen::AngleAxisd(degrees * kDegree, axis));
}

// Pelvis turned by `pelvis`; the trunk bent forward by `bend`, the legs straight below.
LinkPoses Person(const Quaterniond& pelvis, double bend = 0) {
  JointAngles angles{};
  angles[jL5S1].y() = bend * kDegree;
  return ForwardKinematics(DefaultSkeleton(), {Vector3d(3, -1, 1), pelvis}, angles);
}

double Degrees(const LinkPoses& links) { return HeadingOf(links).rad.value() / kDegree; }

TEST(HeadingOf, IsThatOfAStandingPerson) {
  for (const double yaw : {-170.0, -90.0, 0.0, 45.0, 120.0}) {
    EXPECT_NEAR(Degrees(Person(Turn(yaw, Vector3d::UnitZ()))), yaw, 1e-6);
  }
}

TEST(HeadingOf, StaysWhenThePersonBendsOrLeans) {
  const Quaterniond yaw = Turn(70, Vector3d::UnitZ());
  for (const double bend : {30.0, 60.0, 90.0, 110.0}) {
    EXPECT_NEAR(Degrees(Person(yaw, bend)), 70, 1) << bend;
    EXPECT_NEAR(Degrees(Person(yaw * Turn(bend / 2, Vector3d::UnitY()), bend / 2)), 70, 1) << bend;
  }
  EXPECT_NEAR(Degrees(Person(yaw * Turn(40, Vector3d::UnitX()))), 70, 1);
}

TEST(HeadingOf, ShowsALyingPersonFromTheSide) {
  // On the back, head towards +x: the left side looks to -y.
  EXPECT_NEAR(Degrees(Person(Turn(180, Vector3d::UnitZ()) * Turn(-90, Vector3d::UnitY()))), -90, 1);
  EXPECT_EQ(HeadingOf(Person(Turn(-90, Vector3d::UnitY()))).rule, HeadingRule::kLyingLevel);
  // On the left side, head towards +x: the face looks to -y or +y, level.
  const Quaterniond on_side = Turn(90, Vector3d::UnitY()) * Turn(90, Vector3d::UnitZ());
  const Vector3d face = on_side * Vector3d::UnitX();
  EXPECT_NEAR(Degrees(Person(on_side)), std::atan2(face.y(), face.x()) / kDegree, 1);
  EXPECT_EQ(HeadingOf(Person(on_side)).rule, HeadingRule::kLyingOnSide);
}

TEST(HeadingOf, SaysThatAPersonIsUprightAlsoWhenTheyBend) {
  EXPECT_EQ(HeadingOf(Person(Quaterniond::Identity())).rule, HeadingRule::kUpright);
  EXPECT_EQ(HeadingOf(Person(Quaterniond::Identity(), 90)).rule, HeadingRule::kUpright);
}

TEST(HeadingOf, IsUndefinedUpsideDown) {
  const Heading heading = HeadingOf(Person(Turn(150, Vector3d::UnitY()), 30));
  EXPECT_FALSE(heading.rad.has_value());
  EXPECT_EQ(heading.rule, HeadingRule::kUndefined);
}

}  // namespace
}  // namespace kinescope::urdf
