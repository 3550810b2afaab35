#include "core/scene_marker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace kinescope {
namespace {

using ::testing::HasSubstr;

SceneMarker Strip(std::size_t points) {
  SceneMarker marker;
  marker.type = MarkerType::kLineStrip;
  marker.points.assign(points, Eigen::Vector3d::UnitX());
  return marker;
}

std::string DefectOf(const SceneMarker& marker) {
  const auto defect = FindDefect(marker);
  return defect ? defect->text : "";
}

TEST(SceneMarker, HasNoDefectIfItIsValid) {
  EXPECT_EQ(DefectOf(SceneMarker()), "");
  EXPECT_EQ(DefectOf(Strip(2)), "");
  SceneMarker mirrored;
  mirrored.type = MarkerType::kMesh;
  mirrored.mesh_uri = "package://a/b.stl";
  mirrored.scale = {1, -1, 1};
  EXPECT_EQ(DefectOf(mirrored), "") << "as RViz takes it";
  SceneMarker flat = Strip(4);
  flat.scale = {0.1, 0, 0};
  EXPECT_EQ(DefectOf(flat), "") << "a line has but a width";
}

TEST(SceneMarker, NamesItsInvalidField) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  SceneMarker marker;
  marker.pose.position.x() = nan;
  EXPECT_THAT(DefectOf(marker), HasSubstr("position"));
  marker = SceneMarker();
  marker.pose.orientation.coeffs().setZero();
  EXPECT_THAT(DefectOf(marker), HasSubstr("orientation"));
  marker = SceneMarker();
  marker.scale.z() = 0;
  EXPECT_EQ(DefectOf(marker), "its scale.z is 0");
  marker.scale.z() = nan;
  EXPECT_THAT(DefectOf(marker), HasSubstr("scale"));
  marker.scale.z() = -1;
  EXPECT_EQ(DefectOf(marker), "its scale is negative");
  marker = SceneMarker();
  marker.color.w() = nan;
  EXPECT_THAT(DefectOf(marker), HasSubstr("color"));
  marker = SceneMarker();
  marker.type = static_cast<MarkerType>(12);
  EXPECT_THAT(DefectOf(marker), HasSubstr("12"));
  marker.type = MarkerType::kText;
  EXPECT_EQ(DefectOf(marker), "its text is empty");
  marker.type = MarkerType::kMesh;
  EXPECT_EQ(DefectOf(marker), "its mesh name is empty");
}

TEST(SceneMarker, RejectsInvalidNumbersOfPointsAndColours) {
  EXPECT_THAT(DefectOf(Strip(1)), HasSubstr("has 1 points"));
  EXPECT_THAT(DefectOf(Strip(kMaxMarkerPoints + 1)), HasSubstr("at most 100000"));
  SceneMarker pairs = Strip(3);
  pairs.type = MarkerType::kLineList;
  EXPECT_THAT(DefectOf(pairs), HasSubstr("expected pairs"));
  pairs.type = MarkerType::kTriangleList;
  EXPECT_EQ(DefectOf(pairs), "");
  pairs.colors.resize(2, Eigen::Vector4d::Ones());
  EXPECT_EQ(DefectOf(pairs), "2 colors for 3 points");
  pairs.colors.clear();
  pairs.points[1].z() = std::numeric_limits<double>::infinity();
  EXPECT_THAT(DefectOf(pairs), HasSubstr("point"));
}

}  // namespace
}  // namespace kinescope
