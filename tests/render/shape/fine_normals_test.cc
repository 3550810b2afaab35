#include "render/shape/fine_normals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/shape/coarser_skin.h"
#include "render/shape/normal_match.h"
#include "urdf/kinematics.h"
#include "urdf/skeleton.h"
#include "urdf/skin/person_skin.h"

namespace kinescope::render {
namespace {

using Eigen::Vector3f;

// As none of the postures that the normals are made from.
urdf::LinkPoses Walking(const urdf::Skeleton& skeleton) {
  urdf::JointAngles angles{};
  angles[urdf::jRightHip].y() = -0.5;
  angles[urdf::jRightKnee].y() = 0.3;
  angles[urdf::jLeftKnee].y() = 0.7;
  angles[urdf::jLeftElbow].y() = -0.4;
  angles[urdf::jL5S1].z() = 0.2;
  return urdf::ForwardKinematics(skeleton, {}, angles);
}

// Of a triangle's middle, from its corners.
Vector3f MiddleNormal(const skin::PersonSkin::Surface& surface, const skin::Triangle& triangle) {
  return (surface.normals[triangle[0]] + surface.normals[triangle[1]] +
          surface.normals[triangle[2]])
      .normalized();
}

// The mean, by area, of the angle between the normals in the middle of some coarse triangles and
// those of the fine surface closest to there, degrees.
double MeanError(const skin::PersonSkin::Surface& coarse,
                 const std::vector<skin::Triangle>& triangles,
                 const skin::PersonSkin::Surface& fine) {
  double sum = 0, whole = 0;
  for (std::size_t i = 0; i < triangles.size(); i += 11) {
    const skin::Triangle& t = triangles[i];
    const Vector3f middle =
        (coarse.positions[t[0]] + coarse.positions[t[1]] + coarse.positions[t[2]]) / 3;
    const Vector3f normal = MiddleNormal(coarse, t);
    float least = 1e9f;
    const Vector3f* closest = nullptr;
    for (std::size_t k = 0; k < fine.positions.size(); ++k) {
      const float distance = (fine.positions[k] - middle).squaredNorm();
      if (distance >= least) continue;
      least = distance;
      closest = &fine.normals[k];
    }
    const double area = (coarse.positions[t[1]] - coarse.positions[t[0]])
                            .cross(coarse.positions[t[2]] - coarse.positions[t[0]])
                            .norm();
    sum += area * std::acos(std::clamp(normal.dot(*closest), -1.0f, 1.0f)) * 180 / M_PI;
    whole += area;
  }
  return sum / whole;
}

TEST(FineNormals, ShowTheWholeSkinInAPostureOfTheirOwn) {
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton();
  const CoarserSkin coarser = MakeCoarserSkin(skin::BuiltInSkin(), skin::Build(), skeleton, 0.004,
                                              [](const auto&) { return false; });
  const urdf::LinkPoses walking = Walking(skeleton);
  skin::PersonSkin::Surface whole, plain;
  skin::PersonSkin(skin::BuiltInSkin(), skin::Build(), skeleton).Pose(walking, {}, whole);
  skin::PersonSkin(coarser.skin, skin::Build(), skeleton).Pose(walking, {}, plain);
  skin::PersonSkin::Surface fine = plain;
  coarser.normals.Apply(fine);
  for (const Vector3f& normal : fine.normals) ASSERT_NEAR(normal.norm(), 1, 1e-4);
  const auto& triangles = coarser.skin.triangles;
  const double own_error = MeanError(plain, triangles, whole);
  EXPECT_LT(MeanError(fine, triangles, whole), 0.9 * own_error) << own_error;
}

// A roof whose ridge the coarse surface does not have.
TEST(NormalMatch, IsTheBestForAllOfAFineSurface) {
  const std::vector<Vector3f> positions = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 0}};
  const std::vector<skin::Triangle> fine = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  const NormalMatch match(positions, fine, {{0, 1, 2}, {0, 2, 3}});
  const std::vector<Vector3f> even = match.Coarse(std::vector<Vector3f>(5, Vector3f::UnitX()));
  ASSERT_EQ(even.size(), 4U);
  for (const Vector3f& normal : even) EXPECT_LT((normal - Vector3f::UnitX()).norm(), 1e-5);
  std::vector<Vector3f> normals(5, Vector3f::UnitZ());
  normals[4] = Vector3f(1, 0, 1).normalized();
  const std::vector<Vector3f> leaning = match.Coarse(normals);
  // The middle lies on the edge from 0 to 2.
  EXPECT_GT(leaning[0].x(), 0.05f);
  EXPECT_GT(leaning[2].x(), 0.05f);
  EXPECT_NEAR(leaning[1].x(), 0, 1e-5);
}

TEST(NormalMatch, IsTheSurfacesOwnWhereNothingWasLeftOut) {
  const std::vector<Vector3f> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Vector3f> normals = {Vector3f::UnitX(), Vector3f::UnitY(), Vector3f::UnitZ()};
  const std::vector<Vector3f> same =
      NormalMatch(positions, {{0, 1, 2}}, {{0, 1, 2}}).Coarse(normals);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LT((same[i] - normals[i]).norm(), 1e-6);
}

// A triangle of no area, and a vertex without a triangle, as files of others have them.
TEST(FineNormals, LeaveAloneWhereThereIsNoSurface) {
  FineNormals::Posture posture;
  posture.coarse.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 5, 0}};
  posture.coarse.normals.assign(4, Vector3f::UnitZ());
  posture.normals.assign(4, Vector3f::UnitX());
  const FineNormals normals({{0, 1, 2}}, {posture});
  skin::PersonSkin::Surface surface = posture.coarse;
  normals.Apply(surface);
  for (const Vector3f& normal : surface.normals) EXPECT_EQ(normal, Vector3f::UnitZ());
}

}  // namespace
}  // namespace kinescope::render
