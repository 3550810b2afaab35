// The lines of a drawing: where a function on a surface is 0, and which of them are seen.
#include "render/shape/surface_lines.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/shape/visible_lines.h"

namespace kinescope::render {
namespace {

using Eigen::Vector3f;

struct Surface {
  std::vector<Vector3f> positions;
  std::vector<std::uint32_t> triangles;
};

// A sheet in the plane z = 0, `columns` x `rows` squares of size 1.
Surface Sheet(std::uint32_t columns, std::uint32_t rows) {
  Surface sheet;
  for (std::uint32_t y = 0; y <= rows; ++y) {
    for (std::uint32_t x = 0; x <= columns; ++x) {
      sheet.positions.emplace_back(static_cast<float>(x), static_cast<float>(y), 0.0f);
    }
  }
  for (std::uint32_t y = 0; y < rows; ++y) {
    for (std::uint32_t x = 0; x < columns; ++x) {
      const std::uint32_t a = y * (columns + 1) + x, b = a + 1, c = a + columns + 1, d = c + 1;
      sheet.triangles.insert(sheet.triangles.end(), {a, b, d, a, d, c});
    }
  }
  return sheet;
}

Surface Octahedron() {
  return {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
          {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5}};
}

std::vector<float> Values(const Surface& surface, float (*of)(const Vector3f&)) {
  std::vector<float> values;
  for (const Vector3f& p : surface.positions) values.push_back(of(p));
  return values;
}

TEST(ZeroLines, AreOneLineAcrossASheet) {
  const Surface sheet = Sheet(5, 3);
  const auto lines = ZeroLines(sheet.positions, sheet.triangles,
                               Values(sheet, [](const Vector3f& p) { return p.x() - 2.25f; }));
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_FALSE(lines[0].is_loop);
  for (const Vector3f& p : lines[0].points) EXPECT_NEAR(p.x(), 2.25, 1e-6);
  EXPECT_NEAR(std::abs(lines[0].points.front().y() - lines[0].points.back().y()), 3, 1e-6);
}

TEST(ZeroLines, AreALoopAroundAClosedSurface) {
  const Surface body = Octahedron();
  const auto lines =
      ZeroLines(body.positions, body.triangles,
                Values(body, [](const Vector3f& p) { return p.x() + 0.3f * p.y() + 0.1f; }));
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_TRUE(lines[0].is_loop);
  EXPECT_GE(lines[0].points.size(), 6u);
}

TEST(ZeroLines, AreNoneWhereNothingChangesItsSign) {
  const Surface body = Octahedron();
  EXPECT_TRUE(ZeroLines(body.positions, body.triangles, std::vector<float>(6, 1)).empty());
  EXPECT_TRUE(ZeroLines(body.positions, body.triangles, std::vector<float>(6, 0)).empty());
  EXPECT_TRUE(ZeroLines({}, {}, {}).empty());
}

TEST(ZeroLines, AreSeparateLoopsWhereTheyAreApart) {
  Surface two = Octahedron();
  const Surface other = Octahedron();
  for (const Vector3f& p : other.positions) two.positions.emplace_back(p + Vector3f(5, 0, 0));
  for (const std::uint32_t corner : other.triangles) two.triangles.push_back(corner + 6);
  const auto lines = ZeroLines(two.positions, two.triangles,
                               Values(two, [](const Vector3f& p) { return p.z() - 0.5f; }));
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_TRUE(lines[0].is_loop && lines[1].is_loop);
}

// A picture of 100 x 100 px of the plane x = 0, 1 cm per px, seen from +x.
class SeenLines : public ::testing::Test {
 protected:
  SeenLines() {
    camera_.position = {2, 0, 0.5};
    camera_.target = {0, 0, 0.5};
    camera_.ortho_height_m = 1;
    camera_.near_m = 1;
    camera_.far_m = 3;
  }

  std::vector<DrawnLine> Seen(const std::vector<Vector3f>& points, const std::vector<float>& depth,
                              LineKind kind = LineKind::kOutline) const {
    VisibleLines lines({{{points, false}, kind}}, camera_, 100, 100);
    // In two parts, as a large picture is.
    const std::size_t half = depth.size() / 2;
    lines.Judge({0, 50, 100, 50}, 1, {depth.begin(), depth.begin() + static_cast<long>(half)});
    lines.Judge({0, 0, 100, 50}, 1, {depth.begin() + static_cast<long>(half), depth.end()});
    return lines.Take();
  }

  // 80 px long, 30 px above the lower edge.
  const std::vector<Vector3f> across_ = {{0, 0.4f, 0.3f}, {0, -0.4f, 0.3f}};
  Camera camera_;
};

TEST_F(SeenLines, AreWholeWhereNothingIsBeforeThem) {
  const auto lines = Seen(across_, std::vector<float>(10000, 1));
  ASSERT_EQ(lines.size(), 1u);
  const auto& points = lines[0].points;
  EXPECT_LE(points.size(), 3u) << "a straight line needs no more points";
  EXPECT_NEAR(std::abs(points.front().first - points.back().first), 80, 0.01);
  for (const auto& [x, y] : points) EXPECT_NEAR(y, 70, 0.01);
}

TEST_F(SeenLines, EndWhereSomethingIsBeforeThem) {
  std::vector<float> depth(10000, 1);
  for (std::size_t row = 0; row < 100; ++row) {
    for (std::size_t column = 40; column < 60; ++column) depth[100 * row + column] = 0.2f;
  }
  const auto lines = Seen(across_, depth);
  ASSERT_EQ(lines.size(), 2u);
  for (const DrawnLine& line : lines) {
    for (const auto& [x, y] : line.points) EXPECT_TRUE(x < 41.5 || x > 58.5) << x;
  }
}

TEST_F(SeenLines, AreSeenOnTheSurfaceThatTheyAreOn) {
  EXPECT_EQ(Seen(across_, std::vector<float>(10000, 0.5f)).size(), 1u);
  EXPECT_EQ(Seen(across_, std::vector<float>(10000, 0.48f)).size(), 0u);
}

TEST_F(SeenLines, AreNoOutlinesOfKnuckles) {
  const std::vector<float> empty(10000, 1);
  const std::vector<Vector3f> small = {{0, 0.01f, 0.3f}, {0, -0.01f, 0.3f}};
  EXPECT_TRUE(Seen(small, empty).empty());
  EXPECT_EQ(Seen(small, empty, LineKind::kCrease).size(), 1u);
}

TEST_F(SeenLines, AreNoneOutsideThePicture) {
  EXPECT_TRUE(Seen({{0, 4, 0.3f}, {0, 3, 0.3f}}, std::vector<float>(10000, 1)).empty());
}

}  // namespace
}  // namespace kinescope::render
