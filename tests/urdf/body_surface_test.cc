#include "urdf/body_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "tests/urdf/mesh_checks.h"
#include "urdf/kinematics.h"

namespace kinescope::urdf {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using testing::Contains;
using testing::Vertex;
using testing::Volume;

class EverySegment : public ::testing::TestWithParam<int> {
 protected:
  const Skeleton skeleton_ = DefaultSkeleton();
  const TriangleMesh mesh_ = SegmentMesh(skeleton_, GetParam());
};
INSTANTIATE_TEST_SUITE_P(Figure, EverySegment, ::testing::Range(0, kSegmentCount),
                         [](const auto& segment) {
                           return std::string(kSegments[At(segment.param)].mvn_name);
                         });

TEST_P(EverySegment, FacesOutwardWithUnitNormals) {
  EXPECT_GT(Volume(mesh_), 0);
  ASSERT_EQ(mesh_.normals.size(), mesh_.vertices.size());
  for (const Vector3f& normal : mesh_.normals) ASSERT_NEAR(normal.norm(), 1, 1e-5);
  for (const auto& triangle : mesh_.triangles) {
    const Vector3d a = Vertex(mesh_, triangle[0]);
    const Vector3d face = (Vertex(mesh_, triangle[1]) - a).cross(Vertex(mesh_, triangle[2]) - a);
    ASSERT_GT(face.norm(), 1e-10) << "a triangle without area";
    for (const std::uint32_t corner : triangle) {
      ASSERT_GT(mesh_.normals[corner].cast<double>().dot(face.normalized()), 0.2);
    }
  }
}

TEST_P(EverySegment, GrowsWithThePerson) {
  const TriangleMesh tall = SegmentMesh(DefaultSkeleton(2.1), GetParam());
  ASSERT_EQ(tall.vertices.size(), mesh_.vertices.size());
  for (std::size_t i = 0; i < tall.vertices.size(); ++i) {
    ASSERT_LT((tall.vertices[i] - mesh_.vertices[i] * 1.2f).norm(), 1e-5f) << "vertex " << i;
  }
}

TEST_P(EverySegment, CoversItsBoneFromJointToJoint) {
  const bool is_hand = GetParam() == kRightHand || GetParam() == kLeftHand;
  for (const double along : {0.02, 0.25, 0.5, 0.75}) {
    if (is_hand && along > 0.5) continue;  // between two fingers
    // Not to the very end: that of toes and head is on the surface.
    EXPECT_TRUE(Contains(mesh_, along * EndOf(skeleton_, GetParam()))) << along;
  }
}

TEST_P(EverySegment, IsASurfaceEvenForAnImpossibleSkeleton) {
  Skeleton flat;  // every length and the height zero, as a broken stream may claim
  Skeleton folded = skeleton_;
  for (Vector3d& origin : folded.origin_in_parent) origin = -10 * origin;
  for (const Skeleton& skeleton : {flat, folded}) {
    const TriangleMesh mesh = SegmentMesh(skeleton, GetParam());
    EXPECT_EQ(mesh.triangles.size(), mesh_.triangles.size());
    for (const Vector3f& vertex : mesh.vertices) ASSERT_TRUE(vertex.allFinite());
    for (const Vector3f& normal : mesh.normals) ASSERT_TRUE(normal.allFinite());
  }
}

TEST_P(EverySegment, IsTheSameInABinaryStlFile) {
  const std::string stl = ToBinaryStl(mesh_);
  ASSERT_EQ(stl.size(), 84 + 50 * mesh_.triangles.size());
  EXPECT_NE(stl.substr(0, 5), "solid") << "would be taken for the text form";
  const auto read = [&](std::size_t at, auto value) {
    std::memcpy(&value, stl.data() + at, sizeof value);
    return value;
  };
  EXPECT_EQ(read(80, std::uint32_t{}), mesh_.triangles.size());
  for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
    const std::size_t at = 84 + 50 * i;
    const auto vector = [&](std::size_t k) {
      return Vector3f(read(at + 12 * k, 0.0f), read(at + 12 * k + 4, 0.0f),
                      read(at + 12 * k + 8, 0.0f));
    };
    for (std::size_t corner = 0; corner < 3; ++corner) {
      ASSERT_EQ(vector(corner + 1), mesh_.vertices[mesh_.triangles[i][corner]]);
    }
    const Vector3f face = (vector(2) - vector(1)).cross(vector(3) - vector(1));
    ASSERT_GT(vector(0).dot(face.normalized()), 0.999f);
    ASSERT_EQ(read(at + 48, std::uint16_t{}), 0);
  }
}

TEST(Figure, HasLeftSegmentsThatMirrorTheRightOnes) {
  const Skeleton skeleton = DefaultSkeleton();
  for (int right = kRightShoulder; right <= kRightToe; ++right) {
    if (right >= kLeftShoulder && right <= kLeftHand) continue;
    const TriangleMesh a = SegmentMesh(skeleton, right);
    const TriangleMesh b = SegmentMesh(skeleton, right + 4);
    ASSERT_EQ(a.vertices.size(), b.vertices.size());
    // A thumb is lofted the other way round, so vertices are compared as sets: each has its image.
    for (const Vector3f& vertex : a.vertices) {
      const Vector3f image(vertex.x(), -vertex.y(), vertex.z());
      float nearest = 1;
      for (const Vector3f& other : b.vertices) nearest = std::min(nearest, (other - image).norm());
      ASSERT_LT(nearest, 1e-5f) << kSegments[At(right)].mvn_name;
    }
  }
}

TEST(Figure, HasTheSizeOfAPerson) {
  const Skeleton skeleton = DefaultSkeleton();
  const auto origins = NPoseOrigins(skeleton);
  Eigen::AlignedBox3d box;
  double volume = 0;
  for (int i = 0; i < kSegmentCount; ++i) {
    const TriangleMesh mesh = SegmentMesh(skeleton, i);
    for (const Vector3f& vertex : mesh.vertices) box.extend(origins[At(i)] + vertex.cast<double>());
    volume += Volume(mesh);
  }
  EXPECT_NEAR(box.min().z(), 0, 1e-3) << "soles on the floor";
  EXPECT_NEAR(box.max().z(), 1.75, 5e-3);
  EXPECT_NEAR(box.sizes().y(), 0.50, 0.04) << "across the shoulders and hands";
  // Overlaps count twice, and a person of 75 kg takes up about as many litres.
  EXPECT_NEAR(volume, 0.085, 0.020);
}

TEST(Figure, HasAFaceThatLooksForward) {
  const TriangleMesh head = SegmentMesh(DefaultSkeleton(), kHead);
  float front = 0, back = 0;
  Vector3f nose = Vector3f::Zero();
  for (const Vector3f& vertex : head.vertices) {
    if (vertex.x() > front) nose = vertex;
    front = std::max(front, vertex.x());
    back = std::min(back, vertex.x());
  }
  EXPECT_GT(front, -back + 0.02f) << "a nose";
  EXPECT_NEAR(nose.y(), 0, 1e-3f);
  EXPECT_NEAR(nose.z(), 0.04f, 0.02f);
}

}  // namespace
}  // namespace kinescope::urdf
