// The smooth figure as a solid, on bodies of several statures and on those of the real recordings:
// surfaces are closed and right side out, no joint opens however it bends, and nothing flickers
// where two segments meet.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "tests/urdf/example_bodies.h"
#include "tests/urdf/mesh_checks.h"
#include "urdf/body_surface.h"
#include "urdf/joint_limits.h"
#include "urdf/kinematics.h"

namespace kinescope::urdf {
namespace {

using Eigen::Vector3d;
using testing::Contains;
using testing::Corners;
using testing::Winding;

class Figure : public testing::BodyTest {};
INSTANTIATE_TEST_SUITE_P(Bodies, Figure, testing::kBodies, testing::NameOfBody);

std::string_view NameOf(int segment) { return kSegments[At(segment)].mvn_name; }

TEST_P(Figure, HasClosedAndFiniteSurfaces) {
  for (int i = 0; i < kSegmentCount; ++i) {
    SCOPED_TRACE(NameOf(i));
    const TriangleMesh& mesh = meshes_[At(i)];
    for (const Eigen::Vector3f& vertex : mesh.vertices) ASSERT_TRUE(vertex.allFinite());
    for (const Eigen::Vector3f& normal : mesh.normals) ASSERT_NEAR(normal.norm(), 1, 1e-4);
    // Each edge once in each direction: two triangles share it, and agree on what is outside.
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& [a, b, c] : mesh.triangles) {
      ASSERT_LT(std::max({a, b, c}), mesh.vertices.size());
      ++edges[{a, b}];
      ++edges[{b, c}];
      ++edges[{c, a}];
    }
    for (const auto& [edge, count] : edges) {
      ASSERT_EQ(count, 1) << edge.first << " to " << edge.second;
      ASSERT_EQ(edges.count({edge.second, edge.first}), 1U) << edge.first << " to " << edge.second;
    }
  }
}

TEST_P(Figure, HasAsManyTrianglesAsItsShapeNeeds) {
  for (int i = 0; i < kSegmentCount; ++i) {
    // A face and five fingers do not fit into what a limb takes, and segments of the trunk, which
    // twist against each other, show facets that are coarser.
    const bool is_detailed = i == kHead || i == kRightHand || i == kLeftHand;
    const std::size_t most = is_detailed ? 1200 : i <= kNeck ? 850 : 600;
    EXPECT_GE(meshes_[At(i)].triangles.size(), 300U) << NameOf(i);
    EXPECT_LE(meshes_[At(i)].triangles.size(), most) << NameOf(i);
  }
}

TEST_P(Figure, HasNoFaceThatIsInsideOut) {
  // Just below each face the surface winds round once at least, just above never the wrong way.
  constexpr double kJustBeside = 2e-5;
  for (int i = 0; i < kSegmentCount; ++i) {
    const TriangleMesh& mesh = meshes_[At(i)];
    ASSERT_GT(testing::Volume(mesh), 0) << NameOf(i);
    for (std::size_t t = 0; t < mesh.triangles.size(); t += 2) {
      const auto [a, b, c] = Corners(mesh, mesh.triangles[t]);
      const Vector3d area = (b - a).cross(c - a);
      ASSERT_GT(area.norm(), 1e-12) << NameOf(i) << ": triangle " << t << " has no area";
      const Vector3d center = (a + b + c) / 3;
      const Vector3d out = kJustBeside * area.normalized();
      ASSERT_GT(Winding(mesh, center - out), 0.5) << NameOf(i) << " at " << center.transpose();
      ASSERT_GT(Winding(mesh, center + out), -0.5) << NameOf(i) << " at " << center.transpose();
    }
  }
}

// How far a joint is bent here, rad: as far as a living person's goes, which is less than the URDF
// allows where that has room for whole turns.
struct Range {
  double lower, upper;
};
Range RangeOf(int joint, int axis) {
  const AxisLimit limit = LimitOf(joint, axis);
  constexpr double kMax = 170 * M_PI / 180;
  return {std::max(limit.lower, -kMax), std::min(limit.upper, kMax)};
}

// Each axis alone in five steps; then what people combine, by chance.
std::vector<Vector3d> BendsOf(int joint, std::mt19937& random) {
  std::vector<Vector3d> bends = {Vector3d::Zero()};
  for (int axis = 0; axis < 3; ++axis) {
    const Range range = RangeOf(joint, axis);
    for (int step = 0; step <= 4; ++step) {
      Vector3d bend = Vector3d::Zero();
      bend[axis] = range.lower + step * (range.upper - range.lower) / 4;
      bends.push_back(bend);
    }
  }
  std::uniform_real_distribution<double> share(0, 1);
  for (int i = 0; i < 6; ++i) {
    Vector3d bend;
    for (int axis = 0; axis < 3; ++axis) {
      const Range range = RangeOf(joint, axis);
      bend[axis] = 0.6 * (range.lower + share(random) * (range.upper - range.lower));
    }
    bends.push_back(bend);
  }
  return bends;
}

// A ball about the joint, nearly as thick as the limb is there (of a body of 1.75 m), which must
// stay covered: through any gap one would see it.
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

TEST_P(Figure, HasNoGapAtAnyBentJoint) {
  std::mt19937 random(7);
  std::normal_distribution<double> any;
  std::vector<Vector3d> directions(24);
  for (Vector3d& direction : directions) {
    direction = Vector3d(any(random), any(random), any(random)).normalized();
  }
  const double size = skeleton_.height / 1.75;
  for (int joint = 0; joint < kJointCount; ++joint) {
    const TriangleMesh& parent = meshes_[At(ParentOf(joint))];
    const TriangleMesh& child = meshes_[At(ChildOf(joint))];
    const Vector3d& center = skeleton_.origin_in_parent[At(ChildOf(joint))];
    // What the parent covers does not depend on the bend.
    std::vector<Vector3d> open;
    for (const Vector3d& direction : directions) {
      const Vector3d offset = size * CoreRadius(joint) * direction;
      if (!Contains(parent, center + offset)) open.push_back(offset);
    }
    for (const Vector3d& bend : BendsOf(joint, random)) {
      const Eigen::Quaterniond child_from_parent = RotationFromAngles(bend).conjugate();
      for (const Vector3d& offset : open) {
        EXPECT_TRUE(Contains(child, child_from_parent * offset))
            << kJoints[At(joint)].mvn_name << " bent by " << (bend * 180 / M_PI).transpose()
            << " deg gapes at " << offset.transpose();
      }
    }
  }
}

// A point of a surface with what a viewer shades it by.
struct Sample {
  Vector3d position, face_normal, shading_normal;
};

Sample SampleOf(const TriangleMesh& mesh, std::size_t triangle, const Vector3d& origin) {
  const auto [a, b, c] = Corners(mesh, mesh.triangles[triangle]);
  Vector3d shading = Vector3d::Zero();
  for (const std::uint32_t corner : mesh.triangles[triangle]) {
    shading += mesh.normals[corner].cast<double>();
  }
  return {origin + (a + b + c) / 3, (b - a).cross(c - a).normalized(), shading.normalized()};
}

TEST_P(Figure, HasNoFlickeringFacesWhereSegmentsMeet) {
  // Two faces fight for a pixel where they are this near and parallel; it shows if they are shaded
  // differently. 0.1 mm is several steps of the depth buffer at the distance of a picture.
  constexpr double kNear = 1e-4;
  const double parallel = std::cos(2 * M_PI / 180);
  const double alike = std::cos(4 * M_PI / 180);
  const auto origins = NPoseOrigins(skeleton_);
  for (int joint = 0; joint < kJointCount; ++joint) {
    const int one = ParentOf(joint);
    const int other = ChildOf(joint);
    for (const auto& [a, b] : {std::pair{one, other}, std::pair{other, one}}) {
      const TriangleMesh& mesh = meshes_[At(a)];
      const TriangleMesh& neighbour = meshes_[At(b)];
      for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Sample here = SampleOf(mesh, i, origins[At(a)]);
        for (std::size_t k = 0; k < neighbour.triangles.size(); ++k) {
          auto corners = Corners(neighbour, neighbour.triangles[k]);
          for (Vector3d& corner : corners) corner += origins[At(b)];
          if ((corners[0] - here.position).squaredNorm() > 0.05 * 0.05) continue;
          if ((testing::NearestOf(corners, here.position) - here.position).norm() > kNear) continue;
          const Sample there = SampleOf(neighbour, k, origins[At(b)]);
          if (there.face_normal.dot(here.face_normal) < parallel) continue;
          EXPECT_GT(there.shading_normal.dot(here.shading_normal), alike)
              << NameOf(a) << " and " << NameOf(b) << " at " << here.position.transpose();
        }
      }
    }
  }
}

}  // namespace
}  // namespace kinescope::urdf
