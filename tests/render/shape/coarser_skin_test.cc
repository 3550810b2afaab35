#include "render/shape/coarser_skin.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "urdf/skeleton.h"
#include "urdf/skin/occlusion.h"

namespace kinescope::render {
namespace {

constexpr double kError = 0.001;  // m

// Some around the middle of the body, as the hems of a suit.
bool IsHem(const skin::Triangle& triangle) {
  const auto& positions = skin::BuiltInSkin().corners[0];
  return std::any_of(triangle.begin(), triangle.end(), [&](std::uint16_t corner) {
    return std::abs(positions[corner].z() - 0.1f) < 0.01f;
  });
}

skin::SkinTemplate Coarser(const std::function<bool(const skin::Triangle&)>& is_kept) {
  return MakeCoarserSkin(skin::BuiltInSkin(), skin::Build(), urdf::DefaultSkeleton(), kError,
                         is_kept)
      .skin;
}

TEST(CoarserSkin, HasFewerTrianglesAndOnlyTheirVertices) {
  const skin::SkinTemplate& whole = skin::BuiltInSkin();
  const skin::SkinTemplate coarser = Coarser([](const auto&) { return false; });
  EXPECT_LT(coarser.triangles.size(), whole.triangles.size() / 2);
  std::vector<bool> is_used(coarser.size(), false);
  for (const skin::Triangle& triangle : coarser.triangles) {
    for (const std::uint16_t corner : triangle) is_used.at(corner) = true;
  }
  EXPECT_EQ(std::count(is_used.begin(), is_used.end(), false), 0);
  for (const auto& corner : coarser.corners) EXPECT_EQ(corner.size(), coarser.size());
  // As fast to light as the whole: vertices of one limb are still together.
  EXPECT_LE(skin::LimbRunsOf(coarser.weights).size(), skin::LimbRunsOf(whole.weights).size());
}

TEST(CoarserSkin, StaysClosedAroundTrianglesThatAreKept) {
  const skin::SkinTemplate coarser = Coarser(IsHem);
  std::map<std::pair<int, int>, int> edges;
  for (const skin::Triangle& triangle : coarser.triangles) {
    for (std::size_t i = 0; i < 3; ++i) ++edges[{triangle[i], triangle[(i + 1) % 3]}];
  }
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    ASSERT_NE(back, edges.end()) << "an edge of a single triangle";
    ASSERT_EQ(back->second, count);
  }
  const auto& triangles = skin::BuiltInSkin().triangles;
  EXPECT_GT(std::count_if(triangles.begin(), triangles.end(), IsHem), 100);
}

}  // namespace
}  // namespace kinescope::render
