#include "core/scene_extent.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <utility>

namespace kinescope {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

urdf::Visual Shape(urdf::Geometry::Kind kind, const Vector3d& size, const Vector3d& place) {
  urdf::Visual visual;
  visual.link_from_visual = Eigen::Translation3d(place);
  visual.geometry = {kind, size, ""};
  return visual;
}

// Each link is a sphere with a radius of 10 cm.
RobotState RobotWith(const std::vector<Vector3d>& links) {
  RobotState robot;
  auto model = std::make_shared<urdf::RobotModel>();
  for (const Vector3d& place : links) {
    robot.world_from_link.emplace_back(Eigen::Translation3d(place));
    model->links.emplace_back();
    model->links.back().visuals = {
        Shape(urdf::Geometry::Kind::kSphere, {0.1, 0, 0}, Vector3d::Zero())};
  }
  robot.model = model;
  return robot;
}

std::shared_ptr<const SceneMarker> CubeAt(const Vector3d& place, double edge) {
  SceneMarker marker;
  marker.pose.position = place;
  marker.scale = Vector3d::Constant(edge);
  return std::make_shared<const SceneMarker>(marker);
}

void ExpectBox(const AlignedBox3d& box, const Vector3d& lowest, const Vector3d& highest) {
  ASSERT_FALSE(box.isEmpty());
  EXPECT_TRUE(box.min().isApprox(lowest, 1e-9)) << box.min().transpose();
  EXPECT_TRUE(box.max().isApprox(highest, 1e-9)) << box.max().transpose();
}

TEST(SceneExtent, IsEmptyWithoutAnything) {
  EXPECT_TRUE(ExtentOf({}, {}).isEmpty());
  SceneMarker grid = *CubeAt({0, 0, 0}, 1000);
  grid.ns = kNamespaceOfGrids;
  EXPECT_TRUE(ExtentOf({}, {std::make_shared<const SceneMarker>(grid)}).isEmpty());
  const Vector3d nowhere = Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(ExtentOf({RobotWith({nowhere})}, {CubeAt(nowhere, 1)}).isEmpty());
}

TEST(SceneExtent, HasRobotsAndTheMarkersNearThem) {
  RobotState bounded = RobotWith({{9, 9, 9}});
  bounded.bounds = {Vector3d(0, 0, 0), Vector3d(1, 1, 2)};
  ExpectBox(ExtentOf({RobotWith({{-1, 0, 0}, {0, 0.5, 1}}), bounded}, {}), {-1.1, -0.1, -0.1},
            {1, 1, 2});
  ExpectBox(ExtentOf({bounded}, {CubeAt({2, 0.5, 0.5}, 1), CubeAt({100, 0, 0}, 1)}), {0, 0, 0},
            {2.5, 1, 2});
}

TEST(SceneExtent, OfLinksHasTheShapesThatAreDrawn) {
  RobotState robot = RobotWith({{1, 0, 0}, {5, 5, 5}});
  auto model = std::make_shared<urdf::RobotModel>(*robot.model);
  model->links[0].visuals = {
      Shape(urdf::Geometry::Kind::kBox, {0, 6, 8}, {0, 0, 1}),
      Shape(urdf::Geometry::Kind::kCylinder, {3, 8, 0}, {0, 1, 0}),
  };
  model->links[1].visuals.clear();
  robot.model = model;
  ExpectBox(ExtentOf({robot}, {}), {-4, -5, -5}, {6, 6, 6});
}

TEST(SceneExtent, LeavesOutAFewPointsThatAreFarAway) {
  SceneMarker cloud;
  cloud.type = MarkerType::kPoints;
  cloud.pose.position = {10, 0, 0};
  for (int i = 0; i <= 100; ++i) cloud.points.emplace_back(0.01 * i, 0, 0.02 * i);
  cloud.points.emplace_back(0, 80, 0);
  const auto with_one = std::make_shared<const SceneMarker>(cloud);
  const AlignedBox3d box = ExtentOf({}, {with_one});
  EXPECT_EQ(box.max().y(), 0);
  EXPECT_TRUE(box.contains(Vector3d(10.05, 0, 0.1)));
  EXPECT_TRUE(box.contains(Vector3d(10.95, 0, 1.9)));
}

TEST(SceneExtent, OfTrianglesIsScaledAndTurned) {
  SceneMarker marker;
  marker.type = MarkerType::kTriangleList;
  marker.scale = {2, 1, 1};
  marker.pose.orientation = Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ());
  marker.points = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
  ExpectBox(ExtentOf({}, {std::make_shared<const SceneMarker>(marker)}), {0, 0, 0}, {0, 2, 1});
}

TEST(HeldExtent, MovesOnlyWhereSomethingLeavesItOrMuchLessIsThere) {
  HeldExtent held;
  EXPECT_TRUE(held.Follow({}).isEmpty());
  const AlignedBox3d box(Vector3d(0, 0, 0), Vector3d(3, 0, 4));
  ExpectBox(held.Follow(box), {0, 0, 0}, {3, 0, 4});
  ExpectBox(held.Follow({Vector3d(0, 0, 0), Vector3d(3, 0, 3)}), {0, 0, 0}, {3, 0, 4});
  EXPECT_FALSE(held.Follow({}).isEmpty()) << "a message between two has nothing";
  ExpectBox(held.Follow({Vector3d(0, 0, 0), Vector3d(3, 4, 0)}), {-0.5, -0.5, -0.5},
            {3.5, 4.5, 0.5});
  ExpectBox(held.Follow({Vector3d(1, 1, 0), Vector3d(2, 1, 0)}), {0.9, 0.9, -0.1}, {2.1, 1.1, 0.1});
}

}  // namespace
}  // namespace kinescope
