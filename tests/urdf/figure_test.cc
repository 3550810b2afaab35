#include "urdf/figure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <random>

#include "urdf/kinematics.h"

namespace kinescope::urdf {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

Vector3d Vertex(const TriangleMesh& mesh, std::uint32_t index) {
  return mesh.vertices[index].cast<double>();
}

double Volume(const TriangleMesh& mesh) {
  double volume = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    volume += Vertex(mesh, a).dot(Vertex(mesh, b).cross(Vertex(mesh, c))) / 6;
  }
  return volume;
}

// How often the surface winds round `point`: 0 outside, 1 inside a shell, more inside several.
double Winding(const TriangleMesh& mesh, const Vector3d& point) {
  double solid_angle = 0;
  for (const auto& triangle : mesh.triangles) {
    const Vector3d a = Vertex(mesh, triangle[0]) - point;
    const Vector3d b = Vertex(mesh, triangle[1]) - point;
    const Vector3d c = Vertex(mesh, triangle[2]) - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    solid_angle += 2 * std::atan2(a.dot(b.cross(c)),
                                  la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return solid_angle / (4 * M_PI);
}

bool Contains(const TriangleMesh& mesh, const Vector3d& point) {
  return Winding(mesh, point) > 0.5;
}

class EverySegment : public ::testing::TestWithParam<int> {
 protected:
  const Skeleton skeleton_ = DefaultSkeleton();
  const TriangleMesh mesh_ = SegmentMesh(skeleton_, GetParam());
};
INSTANTIATE_TEST_SUITE_P(Figure, EverySegment, ::testing::Range(0, kSegmentCount),
                         [](const auto& segment) {
                           return std::string(kSegments[At(segment.param)].mvn_name);
                         });

TEST_P(EverySegment, IsClosed) {
  // Each edge once in each direction: no holes, no flipped neighbours, no third sheet.
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& [a, b, c] : mesh_.triangles) {
    ASSERT_LT(std::max({a, b, c}), mesh_.vertices.size());
    ++edges[{a, b}];
    ++edges[{b, c}];
    ++edges[{c, a}];
  }
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1) << edge.first << " to " << edge.second;
    ASSERT_EQ(edges.count({edge.second, edge.first}), 1u) << edge.first << " to " << edge.second;
  }
}

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

TEST_P(EverySegment, IsSmallEnoughToDrawManyTimesASecond) {
  EXPECT_GE(mesh_.triangles.size(), 200u);
  EXPECT_LE(mesh_.triangles.size(), 1200u);
}

TEST_P(EverySegment, GrowsWithThePerson) {
  const TriangleMesh tall = SegmentMesh(DefaultSkeleton(2.1), GetParam());
  ASSERT_EQ(tall.vertices.size(), mesh_.vertices.size());
  for (std::size_t i = 0; i < tall.vertices.size(); ++i) {
    ASSERT_LT((tall.vertices[i] - mesh_.vertices[i] * 1.2f).norm(), 1e-5f) << "vertex " << i;
  }
}

TEST_P(EverySegment, CoversItsBoneFromJointToJoint) {
  for (const double along : {0.02, 0.25, 0.5, 0.75}) {
    // Not to the very end: that of toes and head is on the surface, and fingers curl.
    EXPECT_TRUE(Contains(mesh_, along * EndOf(skeleton_, GetParam()))) << along;
  }
}

TEST_P(EverySegment, IsASurfaceEvenWhereTheSkeletonIsNonsense) {
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

TEST_P(EverySegment, IsTheSameAsABinaryStl) {
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

TEST(Figure, LeftIsTheMirrorImageOfRight) {
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

// What a joint does in the extreme, radians: about x, y, z as in the URDF.
std::vector<Vector3d> ExtremesOf(int joint) {
  const auto hinge = [](double from, double to) {
    return std::vector<Vector3d>{{0, from, 0}, {0, (from + to) / 2, 0}, {0, to, 0}};
  };
  switch (joint) {
    case jRightKnee:
    case jLeftKnee: return hinge(0, 2.4);
    case jRightElbow:
    case jLeftElbow: return hinge(-2.5, 0);
    case jRightAnkle:
    case jLeftAnkle: return hinge(-0.6, 0.8);
    case jRightBallFoot:
    case jLeftBallFoot: return hinge(-0.7, 0.1);
    case jRightHip:
    case jLeftHip: return {{0, -2.2, 0}, {0, 0.4, 0}, {0.6, -0.5, 0}, {-0.6, 0, 0}};
    case jRightShoulder:
    case jLeftShoulder: return {{0, -2.9, 0}, {0, 0.8, 0}, {1.57, 0, 0}, {-1.57, 0, 0}};
    case jRightWrist:
    case jLeftWrist: return {{1.2, 0, 0}, {-1.2, 0, 0}, {0, 0.4, 0}, {0, -0.4, 0}};
    default: return {{0, 0.35, 0}, {0, -0.25, 0}, {0.3, 0, 0}, {-0.3, 0, 0}, {0, 0, 0.4}};
  }
}

// A ball about the joint, as thick as the limb's core there, that must stay inside.
double CoreRadius(int joint) {
  switch (joint) {
    case jRightElbow:
    case jLeftElbow: return 0.034;
    case jRightWrist:
    case jLeftWrist: return 0.017;
    case jRightAnkle:
    case jLeftAnkle: return 0.028;
    case jRightBallFoot:
    case jLeftBallFoot: return 0.012;
    case jRightShoulder:
    case jLeftShoulder:
    case jRightC7Shoulder:
    case jLeftC7Shoulder:
    case jT1C7:
    case jC1Head: return 0.040;
    case jRightKnee:
    case jLeftKnee: return 0.047;
    case jRightHip:
    case jLeftHip: return 0.062;
    default: return 0.075;  // the spine
  }
}

TEST(Figure, NoGapOpensAtAnyJointHoweverItBends) {
  const Skeleton skeleton = DefaultSkeleton();
  std::mt19937 random(7);
  std::normal_distribution<double> any;
  std::vector<Vector3d> directions(40);
  for (Vector3d& direction : directions) {
    direction = Vector3d(any(random), any(random), any(random)).normalized();
  }
  for (int joint = 0; joint < kJointCount; ++joint) {
    const TriangleMesh parent = SegmentMesh(skeleton, ParentOf(joint));
    const TriangleMesh child = SegmentMesh(skeleton, ChildOf(joint));
    const Vector3d& center = skeleton.origin_in_parent[At(ChildOf(joint))];
    for (const Vector3d& angles : ExtremesOf(joint)) {
      const Eigen::Quaterniond parent_from_child = RotationFromAngles(angles);
      for (const Vector3d& direction : directions) {
        const Vector3d offset = CoreRadius(joint) * direction;
        const bool covered = Contains(parent, center + offset) ||
                             Contains(child, parent_from_child.conjugate() * offset);
        ASSERT_TRUE(covered) << kJoints[At(joint)].mvn_name << " bent by " << angles.transpose()
                             << " gapes at " << offset.transpose();
      }
    }
  }
}

TEST(Figure, TheFaceLooksForward) {
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
