// The centre of pressure, and how two feet share what the floor gives.
#include "server/loads/ground.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "tests/server/loads/loads_testing.h"

namespace kinescope::loads::testing {
namespace {

constexpr double kGroundMassKg = 75;
constexpr double kTenthOfWeight = 0.1 * kGroundMassKg * kGravity;

// The wrench about the world's origin of `force` at `point`, and `free_moment` about the vertical.
Wrench GroundAt(const Vector3d& force, const Vector3d& point, double free_moment) {
  return {force, point.cross(force) + Vector3d(0, 0, free_moment)};
}

TEST(CenterOfPressure, IsWhereTheForceActsOnTheFloor) {
  Random random(11);
  for (int trial = 0; trial < 100; ++trial) {
    const double floor_z = random.Number(1);
    const Vector3d point(random.Number(2), random.Number(2), floor_z);
    const Vector3d force(random.Number(300), random.Number(300), 700 + random.Number(400));
    const double free_moment = random.Number(20);
    const auto cop =
        FindCenterOfPressure(GroundAt(force, point, free_moment), floor_z, kGroundMassKg);
    ASSERT_TRUE(cop);
    EXPECT_NEAR((cop->point - point.head<2>()).norm(), 0, 1e-12);
    EXPECT_NEAR(cop->free_moment, free_moment, 1e-9);
  }
}

TEST(CenterOfPressure, IsAbsentBelowATenthOfTheWeight) {
  const auto has_cop = [](double vertical) {
    return FindCenterOfPressure(GroundAt({0, 0, vertical}, Vector3d::Zero(), 0), 0, kGroundMassKg)
        .has_value();
  };
  EXPECT_TRUE(has_cop(kTenthOfWeight + 1e-9));
  EXPECT_FALSE(has_cop(kTenthOfWeight - 1e-9));
  EXPECT_FALSE(has_cop(0));
  EXPECT_FALSE(has_cop(-700)) << "a floor does not pull";
  EXPECT_FALSE(has_cop(std::numeric_limits<double>::quiet_NaN()));
}

// Right foot at y = -0.1, left at y = 0.1.
std::array<FootOnGround, 2> TwoFeet(double right_weight = 1, double left_weight = 1) {
  std::array<FootOnGround, 2> feet;
  feet[kRight] = {{0, -0.1}, right_weight};
  feet[kLeft] = {{0, 0.1}, left_weight};
  return feet;
}

// What both feet together do about the point `about` of the floor.
Wrench SumOf(const GroundSplit& split, const Vector2d& about) {
  Wrench sum;
  for (const FootShare& foot : split.feet) {
    const Vector2d arm = foot.point - about;
    sum.force += foot.force;
    sum.moment +=
        Vector3d(arm.x(), arm.y(), 0).cross(foot.force) + Vector3d(0, 0, foot.free_moment);
  }
  return sum;
}

TEST(GroundSplit, AddsUpToTheTotalForce) {
  Random random(12);
  for (int trial = 0; trial < 100; ++trial) {
    CenterOfPressure cop;
    cop.point = {random.Number(0.2), random.Number(0.1)};
    cop.free_moment = random.Number(20);
    const Vector3d force(random.Number(100), random.Number(100), 700);
    const GroundSplit split = SplitGround(force, cop, TwoFeet());
    const Wrench sum = SumOf(split, cop.point);
    EXPECT_NEAR((sum.force - force).norm(), 0, 1e-9);
    EXPECT_NEAR((sum.moment - Vector3d(0, 0, cop.free_moment)).norm(), 0, 1e-9);
    EXPECT_NEAR(split.feet[kRight].force.cross(split.feet[kLeft].force).norm(), 0, 1e-6)
        << "parallel";
  }
}

TEST(GroundSplit, GivesTheNearerFootMore) {
  const auto right_share = [](double y) {
    CenterOfPressure cop;
    cop.point = {0.03, y};
    return SplitGround({0, 0, 700}, cop, TwoFeet()).right_share;
  };
  EXPECT_NEAR(right_share(0), 0.5, 1e-12);
  EXPECT_NEAR(right_share(-0.05), 0.75, 1e-12);
  EXPECT_NEAR(right_share(-0.1), 1, 1e-12);
  EXPECT_NEAR(right_share(0.1), 0, 1e-12);
  EXPECT_NEAR(right_share(-0.4), 1, 1e-12) << "no foot pulls";
  EXPECT_NEAR(right_share(0.4), 0, 1e-12);
}

TEST(GroundSplit, GivesAFootInTheAirNothing) {
  CenterOfPressure cop;
  for (const double y : {-0.1, -0.05, 0.0, 0.1}) {
    cop.point = {0, y};
    EXPECT_EQ(SplitGround({0, 0, 700}, cop, TwoFeet(1, 0)).feet[kLeft].force, Vector3d::Zero());
    const GroundSplit on_left = SplitGround({0, 0, 700}, cop, TwoFeet(0, 1));
    EXPECT_EQ(on_left.feet[kRight].force, Vector3d::Zero());
    EXPECT_EQ(on_left.feet[kLeft].force, Vector3d(0, 0, 700)) << y;
  }
}

TEST(GroundSplit, ReducesTheShareOfALiftedFootGradually) {
  CenterOfPressure cop;
  cop.point = {0, 0};
  double last = 0;
  for (const double weight : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const double share = SplitGround({0, 0, 700}, cop, TwoFeet(weight, 1)).right_share;
    EXPECT_NEAR(share, weight / (weight + 1), 1e-12);
    EXPECT_GE(share, last);
    last = share;
  }
}

TEST(GroundSplit, GivesFeetLessThanFiveCentimetresApartEqualShares) {
  std::array<FootOnGround, 2> feet = TwoFeet();
  feet[kRight].center = {0, -0.0249};
  feet[kLeft].center = {0, 0.0249};
  CenterOfPressure cop;
  cop.point = {0, -0.0249};
  EXPECT_NEAR(SplitGround({0, 0, 700}, cop, feet).right_share, 0.5, 1e-12);
  feet[kLeft].center.y() = 0.0252;  // 5.01 cm
  EXPECT_NEAR(SplitGround({0, 0, 700}, cop, feet).right_share, 1, 1e-12);
}

}  // namespace
}  // namespace kinescope::loads::testing
