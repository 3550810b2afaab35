#include "render/shape/wrong_light.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "render/shape/normal_match.h"
#include "urdf/skin/person_skin.h"

namespace kinescope::render {
namespace {

using Eigen::Vector3f;
using Surface = skin::PersonSkin::Surface;

// A square of 2 m a side, with a vertex in its middle that the coarse surface does not have.
class WrongLightTest : public ::testing::Test {
 protected:
  static Surface Level(std::vector<Vector3f> positions) {
    return {positions, std::vector<Vector3f>(positions.size(), Vector3f::UnitZ())};
  }
  static Vector3f Leaning(double degrees) {
    const double angle = degrees * M_PI / 180;
    return Eigen::Vector3d(std::sin(angle), 0, std::cos(angle)).cast<float>();
  }

  const std::vector<skin::Triangle> fine_triangles_ = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  const std::vector<skin::Triangle> coarse_triangles_ = {{0, 1, 2}, {0, 2, 3}};
  Surface fine_ = Level({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 0}});
  Surface coarse_ = Level({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
  const NormalMatch match_{fine_.positions, fine_triangles_, coarse_triangles_};
  WrongLight wrong_{match_, fine_, fine_triangles_};
};

TEST_F(WrongLightTest, IsNowhereIfNormalsAreAbout) {
  coarse_.normals[1] = Leaning(18);
  wrong_.Add(fine_, coarse_, coarse_triangles_);
  EXPECT_EQ(wrong_.areas(), std::vector<float>(5, 0.0f));
}

TEST_F(WrongLightTest, GrowsWithTheAreaAndTheAngle) {
  coarse_.normals[1] = Leaning(60);
  coarse_.normals[3] = Leaning(90);
  wrong_.Add(fine_, coarse_, coarse_triangles_);
  // A third of two triangles of 1 m^2.
  EXPECT_NEAR(wrong_.areas()[1], 2.0 / 3 * 0.5, 1e-5);
  EXPECT_NEAR(wrong_.areas()[3], 2.0 / 3, 1e-5);
  EXPECT_EQ(wrong_.areas()[0], 0);
}

TEST_F(WrongLightTest, IsAlsoAtVerticesThatTheCoarseSurfaceDoesNotHave) {
  fine_.normals[4] = Leaning(90);
  wrong_.Add(fine_, coarse_, coarse_triangles_);
  EXPECT_NEAR(wrong_.areas()[4], 4.0 / 3, 1e-5);
  EXPECT_EQ(wrong_.areas()[0], 0);
}

TEST_F(WrongLightTest, IsThatOfTheWorstPosture) {
  Surface leaning = coarse_;
  leaning.normals[1] = Leaning(90);
  wrong_.Add(fine_, coarse_, coarse_triangles_);
  wrong_.Add(fine_, leaning, coarse_triangles_);
  wrong_.Add(fine_, coarse_, coarse_triangles_);
  EXPECT_NEAR(wrong_.areas()[1], 2.0 / 3, 1e-5);
}

TEST_F(WrongLightTest, IsWhereATriangleShowsItsBack) {
  coarse_.positions[1] = {0, 2, 0};  // beyond the edge from 0 to 2
  wrong_.Add(fine_, coarse_, coarse_triangles_);
  for (const std::size_t corner : {0U, 1U, 2U}) EXPECT_NEAR(wrong_.areas()[corner], 2, 1e-5);
  EXPECT_EQ(wrong_.areas()[3], 0);
}

}  // namespace
}  // namespace kinescope::render
