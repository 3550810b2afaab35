#include "render/shape/coarser_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace kinescope::render {
namespace {

constexpr double kRadius = 0.1, kError = 0.004;  // m

urdf::Mesh Ball(int part) {
  urdf::Mesh mesh = urdf::SphereMesh(kRadius, {0, 0, 48});
  mesh.Paint(0, Eigen::Vector4f::Ones(), part);
  return mesh;
}

TEST(CoarserMesh, HasFewerTrianglesAndKeepsTheShape) {
  const urdf::Mesh fine = Ball(0), coarser = CoarserMesh(fine, kError);
  EXPECT_LT(coarser.triangles.size(), fine.triangles.size() / 4);
  for (std::size_t i = 0; i < coarser.triangles.size(); i += 3) {
    Eigen::Vector3f middle = Eigen::Vector3f::Zero();
    for (std::size_t corner = 0; corner < 3; ++corner) {
      middle += coarser.positions[coarser.triangles[i + corner]] / 3;
    }
    EXPECT_NEAR(middle.norm(), kRadius, 2 * kError) << "triangle " << i / 3;
  }
}

// A left and a right limb may have the same shape, each in its own frame.
TEST(CoarserMesh, KeepsPartsApartThatHaveTheSamePositions) {
  urdf::Mesh both = Ball(0);
  both.Append(Ball(1), Eigen::Affine3d::Identity());
  both.Paint(both.positions.size() / 2, Eigen::Vector4f::Ones(), 1);
  const auto one = static_cast<double>(CoarserMesh(Ball(0), kError).triangles.size());
  const urdf::Mesh coarser = CoarserMesh(both, kError);
  EXPECT_NEAR(static_cast<double>(coarser.triangles.size()), 2 * one, 0.2 * one);
  const auto farthest =
      std::max_element(coarser.positions.begin(), coarser.positions.end(),
                       [](const auto& a, const auto& b) { return a.norm() < b.norm(); });
  EXPECT_LE(farthest->norm(), kRadius * 1.001) << "in the frames of their parts";
}

}  // namespace
}  // namespace kinescope::render
