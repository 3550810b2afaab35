#include "render/shape/marker_shapes.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <memory>

#include "tests/temp_folder.h"

namespace kinescope::render {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

MarkerShapes ShapesOf(const SceneMarker& marker) {
  return MarkerReader(100'000).Read({std::make_shared<SceneMarker>(marker)});
}

// Measured in RViz 1.14: the shaft is as thick as scale.y and scale.z say, the head twice.
TEST(MarkerShapes, HaveArrowsOfAPoseAsRvizDoes) {
  SceneMarker arrow;
  arrow.type = MarkerType::kArrow;
  arrow.scale = {2, 0.3, 0.1};
  const MarkerShapes shapes = ShapesOf(arrow);
  ASSERT_EQ(shapes.boxes.size(), 1u);
  const Eigen::Vector3f size = shapes.boxes[0].box.sizes();
  EXPECT_NEAR(size.x(), 2, 1e-5);
  EXPECT_NEAR(size.y(), 0.6, 0.01);
  EXPECT_NEAR(size.z(), 0.2, 0.01);
  float shaft = 0;
  for (const Eigen::Vector3f& position : shapes.solid.mesh.positions) {
    if (position.x() < 0.1f) shaft = std::max(shaft, position.y());
  }
  EXPECT_NEAR(shaft, 0.15, 0.005);
}

TEST(MarkerShapes, HaveRoundSpheresInAList) {
  SceneMarker list;
  list.type = MarkerType::kSphereList;
  list.scale = {0.4, 2, 3};
  list.points = {{0, 0, 0}};
  EXPECT_NEAR(ShapesOf(list).boxes.at(0).box.sizes().maxCoeff(), 0.4, 1e-5) << "as RViz's";
}

TEST(MarkerShapes, TintTheColoursOfAFile) {
  const kinescope::testing::TempFolder folder;
  std::ofstream(folder / "red.mtl") << "newmtl red\nKd 1 0 0\n";
  std::ofstream(folder / "red.obj")
      << "mtllib red.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n";
  SceneMarker marker;
  marker.type = MarkerType::kMesh;
  marker.mesh_uri = "file://" + (folder / "red.obj").string();
  marker.mesh_has_own_colors = true;
  const auto color_with = [&](const Eigen::Vector4d& color) {
    marker.color = color;
    const MarkerShapes shapes = ShapesOf(marker);
    EXPECT_THAT(shapes.problems, IsEmpty());
    const bool is_solid = !shapes.solid.mesh.colors.empty();
    return (is_solid ? shapes.solid : shapes.blended).mesh.colors.at(0);
  };
  EXPECT_TRUE(color_with({0, 0, 0, 0}).isApprox(Eigen::Vector4f(1, 0, 0, 1), 0.01f));
  EXPECT_TRUE(color_with({0, 0, 1, 1}).isApprox(Eigen::Vector4f(0.5f, 0, 0.5f, 1), 0.01f));
  // Half of red, then half of blue over it.
  EXPECT_TRUE(
      color_with({0, 0, 1, 0.5}).isApprox(Eigen::Vector4f(1.0f / 3, 0, 2.0f / 3, 0.75f), 0.01f));
}

// Many nodes ask for the colours of an STL file, which has none, and give none themselves.
TEST(MarkerShapes, AreSeenWhereTheFileThatIsToHaveColoursHasNone) {
  const kinescope::testing::TempFolder folder;
  std::ofstream(folder / "plain.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  SceneMarker marker;
  marker.type = MarkerType::kMesh;
  marker.mesh_uri = "file://" + (folder / "plain.obj").string();
  marker.mesh_has_own_colors = true;
  marker.color.setZero();
  const urdf::Mesh mesh = ShapesOf(marker).blended.mesh;
  ASSERT_FALSE(mesh.colors.empty());
  EXPECT_EQ(mesh.colors[0].w(), 1);
}

TEST(MarkerShapes, HaveLinesOfAPixelWithoutTriangles) {
  SceneMarker lines;
  lines.ns = "rviz/Grid";
  lines.type = MarkerType::kLineList;
  lines.is_in_pixels = true;
  lines.pose.position = {0, 0, 2};
  lines.points = {{0, 0, 0}, {1, 0, 0}};
  const MarkerShapes shapes = ShapesOf(lines);
  EXPECT_THAT(shapes.solid.mesh.triangles, IsEmpty());
  ASSERT_EQ(shapes.lines.size(), 1u);
  EXPECT_EQ(shapes.lines[0].name, "rviz/Grid/0");
  EXPECT_FALSE(shapes.lines[0].is_blended);
  EXPECT_THAT(shapes.lines[0].positions,
              ElementsAre(Eigen::Vector3f(0, 0, 2), Eigen::Vector3f(1, 0, 2)));
}

TEST(MarkerShapes, JoinThePointsOfAStripWithLinesOfAPixel) {
  SceneMarker strip;
  strip.type = MarkerType::kLineStrip;
  strip.is_in_pixels = true;
  strip.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  strip.colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}};
  const MarkerShapes shapes = ShapesOf(strip);
  ASSERT_EQ(shapes.lines.size(), 1u);
  EXPECT_THAT(shapes.lines[0].positions,
              ElementsAre(Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(1, 0, 0),
                          Eigen::Vector3f(1, 0, 0), Eigen::Vector3f(1, 1, 0)));
  ASSERT_EQ(shapes.lines[0].colors.size(), 4u);
  EXPECT_EQ(shapes.lines[0].colors[2], Eigen::Vector4f(0, 1, 0, 1));
}

// Whatever the order of their topics.
TEST(MarkerShapes, HaveTheGroundFromBelowThenTheLargerFirst) {
  const auto square = [](const char* name, GroundLayer layer, double side, double height = 0) {
    auto marker = std::make_shared<SceneMarker>();
    marker->ns = name;
    marker->type = MarkerType::kTriangleList;
    marker->ground = layer;
    marker->points = {{0, 0, 0}, {side, 0, 0}, {side, side, 0}};
    marker->pose.position.z() = height;
    return marker;
  };
  auto wall = square("wall", GroundLayer::kNone, 9);
  auto broken = square("broken", GroundLayer::kMap, 9);
  broken->points.pop_back();
  const MarkerShapes shapes = MarkerReader(100'000).Read(
      {square("obstacles", GroundLayer::kCells, 50), square("upstairs", GroundLayer::kMap, 9, 3),
       square("local", GroundLayer::kMap, 1), wall, square("building", GroundLayer::kMap, 9, 0.001),
       broken, square("behind", GroundLayer::kFirstMap, 2)});
  EXPECT_THAT(shapes.ground.names,
              ElementsAre("behind/0", "building/0", "local/0", "obstacles/0", "upstairs/0"));
  EXPECT_THAT(shapes.solid.names, ElementsAre("wall/0"));
  EXPECT_EQ(shapes.boxes.size(), 6u);
  EXPECT_EQ(shapes.ground.mesh.parts.front(), 0);
  EXPECT_EQ(shapes.ground.mesh.parts.back(), 4);
  EXPECT_EQ(shapes.problems.size(), 1u);
}

}  // namespace
}  // namespace kinescope::render
