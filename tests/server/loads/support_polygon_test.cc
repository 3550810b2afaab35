#include "server/loads/support_polygon.h"

#include "tests/server/loads/loads_testing.h"

namespace kinescope::loads::testing {
namespace {

SupportPolygon HullOf(const std::vector<Vector2d>& points) {
  std::array<Vector2d, kMaxSupportPoints> all;
  std::copy(points.begin(), points.end(), all.begin());
  return ConvexHull(all, points.size());
}

double AreaOf(const SupportPolygon& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size; ++i) {
    const Vector2d& a = polygon.corners[i];
    const Vector2d& b = polygon.corners[(i + 1) % polygon.size];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

TEST(SupportPolygon, IsTheHullWithoutPointsInsideOrOnEdges) {
  const SupportPolygon square =
      HullOf({{0, 0}, {2, 0}, {1, 0}, {2, 2}, {1, 1}, {0, 2}, {2, 1}, {0, 0}, {0.5, 1.9}});
  ASSERT_EQ(square.size, 4U);
  EXPECT_NEAR(AreaOf(square), 4, 1e-12) << "not counter-clockwise";
  EXPECT_NEAR(DistanceInside(square, {0.25, 1}), 0.25, 1e-12);
  EXPECT_NEAR(DistanceInside(square, {-3, -4}), -5, 1e-12);
  EXPECT_EQ(ClampInto(square, {3, 1}), Vector2d(2, 1));
  EXPECT_EQ(ClampInto(square, {0.5, 0.5}), Vector2d(0.5, 0.5));
}

TEST(SupportPolygon, MayBeALineOrAPoint) {
  const SupportPolygon line = HullOf({{0, 0}, {0, 0}, {1, 0}});
  EXPECT_EQ(line.size, 2U);
  EXPECT_NEAR(DistanceInside(line, {0.5, 1}), -1, 1e-12);
  EXPECT_EQ(ClampInto(line, {0.5, 1}), Vector2d(0.5, 0));
  const SupportPolygon point = HullOf({{1, 1}, {1, 1}});
  EXPECT_EQ(point.size, 1U);
  EXPECT_EQ(ClampInto(point, {4, 4}), Vector2d(1, 1));
  const SupportPolygon straight = HullOf({{0, 0}, {1, 1}, {2, 2}, {3, 3}});
  EXPECT_EQ(straight.size, 2U);
}

TEST(SupportPolygon, ContainsItsPointsAndClampsOtherPointsToItsBorder) {
  Random random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<Vector2d> points;
    for (std::size_t i = 0; i < 1 + static_cast<std::size_t>(trial) % kMaxSupportPoints; ++i) {
      points.push_back(random.Vector(1).head<2>());
    }
    const SupportPolygon hull = HullOf(points);
    for (const Vector2d& point : points) {
      EXPECT_GT(DistanceInside(hull, point), -1e-12);
    }
    const Vector2d anywhere = random.Vector(3).head<2>();
    const Vector2d clamped = ClampInto(hull, anywhere);
    EXPECT_NEAR((clamped - anywhere).norm(), std::max(0.0, -DistanceInside(hull, anywhere)), 1e-12);
    for (const Vector2d& point : points) {  // none of them is nearer
      EXPECT_LE((clamped - anywhere).norm(), (point - anywhere).norm() + 1e-12);
    }
  }
}

TEST(ExtrapolatedCenterOfMass, IsAheadOfAMovingBody) {  // Hof 2005: v / sqrt(g / l)
  const Vector2d xcom = ExtrapolatedCenterOfMass({0.1, 0, 0.981 + 0.2}, {0.5, -1, 3}, 0.2);
  EXPECT_NEAR(xcom.x(), 0.1 + 0.5 * std::sqrt(0.1), 1e-12);
  EXPECT_NEAR(xcom.y(), -std::sqrt(0.1), 1e-12);
}

}  // namespace
}  // namespace kinescope::loads::testing
