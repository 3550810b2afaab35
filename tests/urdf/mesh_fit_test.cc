#include "urdf/mesh_fit.h"

#include <gtest/gtest.h>

#include "tests/urdf/mesh_checks.h"

namespace kinescope::urdf {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using Frame = MeshConvention::Frame;

// A box with these corners: what a segment of somebody's set may look like.
TriangleMesh Box(const Vector3d& low, const Vector3d& high) {
  TriangleMesh box;
  for (int i = 0; i < 8; ++i) {
    box.vertices.push_back(Vector3d((i & 1) != 0 ? high.x() : low.x(),
                                    (i & 2) != 0 ? high.y() : low.y(),
                                    (i & 4) != 0 ? high.z() : low.z())
                               .cast<float>());
  }
  box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return box;
}

void ExpectBounds(const TriangleMesh& mesh, const Vector3d& low, const Vector3d& high) {
  const Eigen::AlignedBox3d box = BoundsOf(mesh);
  EXPECT_LT((box.min() - low).norm(), 1e-6) << box.min().transpose();
  EXPECT_LT((box.max() - high).norm(), 1e-6) << box.max().transpose();
  EXPECT_GT(testing::Volume(mesh), 0) << "inside out";
}

TEST(MeshFit, ConvertsUnitsToMetresAndTheUpAxisToZ) {
  const TriangleMesh millimetres = Box({-50, -400, -60}, {50, 20, 60});
  MeshConvention convention;
  convention.metres_per_unit = 0.001;
  convention.y_is_up = true;
  ExpectBounds(ToLinkFrame(millimetres, convention, kLeftLowerLeg), {-0.05, -0.06, -0.4},
               {0.05, 0.06, 0.02});
}

TEST(MeshFit, TurnsArmsOfTheTPoseDownInLinkFrames) {
  const TriangleMesh right = Box({-0.03, -0.25, -0.04}, {0.05, 0.01, 0.02});
  MeshConvention convention;
  for (const Frame frame : {Frame::kSegment, Frame::kLonger}) {
    convention.frame = frame;
    // Palms down becomes palms to the thighs: what was below is inside, which is +y on the right.
    ExpectBounds(ToLinkFrame(right, convention, kRightForeArm), {-0.03, -0.02, -0.25},
                 {0.05, 0.04, 0.01});
  }
  convention.frame = Frame::kLink;
  ExpectBounds(ToLinkFrame(right, convention, kRightForeArm), {-0.03, -0.25, -0.04},
               {0.05, 0.01, 0.02});
  convention.frame = Frame::kSegment;
  ExpectBounds(ToLinkFrame(right, convention, kRightUpperLeg), {-0.03, -0.25, -0.04},
               {0.05, 0.01, 0.02});
}

TEST(MeshFit, KeepsTheOriginAtTheJointAndScalesToThePersonsSegmentLength) {
  const Skeleton skeleton = DefaultSkeleton();
  const double length = -EndOf(skeleton, kLeftUpperLeg).z();
  const TriangleMesh thigh = Box({-0.06, -0.05, -0.4}, {0.07, 0.06, 0.02});
  ExpectBounds(FitToPerson(thigh, skeleton, kLeftUpperLeg), {-0.06, -0.05, -length},
               {0.07, 0.06, 0.02 * length / 0.4});
}

TEST(MeshFit, MovesACentredMeshOntoItsSegment) {
  const Skeleton skeleton = DefaultSkeleton(1.95);
  const double length = -EndOf(skeleton, kRightLowerLeg).z();
  const TriangleMesh shank = Box({-0.06, -0.06, -0.2}, {0.06, 0.05, 0.2});
  ExpectBounds(FitToPerson(shank, skeleton, kRightLowerLeg), {-0.06, -0.06, -length},
               {0.06, 0.05, 0});
  const TriangleMesh chest = Box({-0.1, -0.16, -0.1}, {0.1, 0.16, 0.1});
  ExpectBounds(FitToPerson(chest, skeleton, kT8), {-0.1, -0.16, 0},
               {0.1, 0.16, EndOf(skeleton, kT8).z()});
}

TEST(MeshFit, PutsFeetOnTheFloor) {
  const Skeleton skeleton = DefaultSkeleton(1.6);
  const auto origins = NPoseOrigins(skeleton);
  const TriangleMesh foot = Box({-0.05, -0.04, -0.03}, {0.15, 0.04, 0.05});
  const double lowest = BoundsOf(FitToPerson(foot, skeleton, kLeftFoot)).min().z();
  EXPECT_NEAR(origins[kLeftFoot].z() + lowest, 0, 1e-6);
  const TriangleMesh toe = Box({-0.08, -0.04, -0.02}, {0, 0.04, 0.02});
  const Eigen::AlignedBox3d box = BoundsOf(FitToPerson(toe, skeleton, kRightToe));
  EXPECT_NEAR(origins[kRightToe].z() + box.min().z(), 0, 1e-6);
  EXPECT_NEAR(box.min().x(), 0, 1e-6);
  EXPECT_NEAR(box.max().x(), EndOf(skeleton, kRightToe).x(), 1e-6);
}

TEST(MeshFit, StaysFiniteForAnImpossibleMeshOrSkeleton) {
  for (int i = 0; i < kSegmentCount; ++i) {
    for (const TriangleMesh& mesh :
         {TriangleMesh(), Box({0, 0, 0}, {0, 0, 0}), Box({-1, -1, -1}, {1, 1, 1})}) {
      for (const Skeleton& skeleton : {Skeleton(), DefaultSkeleton()}) {
        for (const Vector3f& vertex : FitToPerson(mesh, skeleton, i).vertices) {
          ASSERT_TRUE(vertex.allFinite());
          ASSERT_LT(vertex.norm(), 20);
        }
      }
    }
  }
}

}  // namespace
}  // namespace kinescope::urdf
