#include "urdf/hand_surface.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>

#include "tests/urdf/mesh_checks.h"

namespace kinescope::urdf {
namespace {

using Eigen::Vector3d;
using testing::Contains;
using testing::Vertex;
using testing::Volume;

// Every edge is there once in each direction.
void ExpectClosed(const TriangleMesh& mesh, const std::string& name) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) ++edges[{triangle[i], triangle[(i + 1) % 3]}];
  }
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    ASSERT_TRUE(count == 1 && back != edges.end() && back->second == 1) << name;
  }
}

std::string Name(int finger) { return std::string(kFingers[At(finger)]); }

TEST(HandFigure, ConsistsOfClosedShellsThatFaceOutwardAndContainTheirBones) {
  for (const double length : {0.12, 0.19, 0.24}) {
    const HandSkeleton hand = DefaultHand(kRight, length);
    for (int i = 0; i < kFingersPerHand; ++i) {
      const TriangleMesh mesh = FingerMesh(hand, i);
      ExpectClosed(mesh, Name(i));
      EXPECT_GT(Volume(mesh), 0) << Name(i);
      EXPECT_LE(mesh.triangles.size(), 600u) << Name(i);
      ASSERT_EQ(mesh.normals.size(), mesh.vertices.size());
      const Vector3d end = EndOf(hand, i);
      for (const double share : {0.02, 0.5, 0.85}) {
        EXPECT_TRUE(Contains(mesh, share * end)) << Name(i) << " at " << share;
      }
    }
  }
}

TEST(HandFigure, EndsAtTheFingertip) {
  const HandSkeleton hand = DefaultHand(kLeft, 0.19);
  for (int i = 1; i < kFingersPerHand; ++i) {
    if (!IsFingertip(i)) continue;
    const TriangleMesh mesh = FingerMesh(hand, i);
    const Vector3d along = EndOf(hand, i).normalized();
    double farthest = 0;
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
      farthest = std::max(farthest, along.dot(Vertex(mesh, v)));
    }
    EXPECT_NEAR(farthest, EndOf(hand, i).norm(), 1e-6) << Name(i);
  }
}

// Both ends of a joint are balls about it, so a turn opens nothing: from one to the other there is
// no way out.
TEST(HandFigure, HasNoGapAtAnyBentJoint) {
  const HandSkeleton hand = DefaultHand(kRight, 0.19);
  for (int i = 1; i < kFingersPerHand; ++i) {
    const int parent = kFingerParents[At(i)];
    const TriangleMesh upper = FingerMesh(hand, parent), lower = FingerMesh(hand, i);
    const Vector3d joint = hand.origin_in_parent[At(i)];
    EXPECT_TRUE(Contains(upper, joint)) << Name(i) << ": its joint is outside its parent";
    if (parent == 0) continue;
    double smallest = std::numeric_limits<double>::max();
    for (std::uint32_t v = 0; v < lower.vertices.size(); ++v) {
      smallest = std::min(smallest, Vertex(lower, v).norm());
    }
    for (std::uint32_t v = 0; v < upper.vertices.size(); ++v) {
      const Vector3d beyond = Vertex(upper, v) - joint;
      if (beyond.dot(EndOf(hand, parent)) <= 0) continue;  // not of the rounded end
      EXPECT_NEAR(beyond.norm(), smallest, 0.06 * smallest + 1e-4)
          << Name(i) << ": the ball at its joint is not that of its parent";
    }
  }
}

TEST(HandFigure, HasAPalmThatCoversEveryKnuckleAndTheWrist) {
  HandSkeleton hand = DefaultHand(kLeft, 0.19);
  for (const Vector3d& carpus : {Vector3d(0, 0, 0), Vector3d(0.004, -0.003, -0.02)}) {
    hand.origin_in_parent[0] = carpus;
    const TriangleMesh palm = FingerMesh(hand, 0);
    EXPECT_TRUE(Contains(palm, -carpus)) << "the wrist";
    for (int ray = 1; ray < 5; ++ray) {
      const int metacarpal = MetacarpalOf(ray);
      const Vector3d base = hand.origin_in_parent[At(metacarpal)];
      const Vector3d knuckle = base + hand.origin_in_parent[At(metacarpal) + 1];
      EXPECT_TRUE(Contains(palm, base + 0.9 * (knuckle - base))) << ray;
    }
  }
}

// Scale data may say anything.
TEST(HandFigure, IsASurfaceEvenForImpossibleBones) {
  HandSkeleton none;
  none.origin_in_parent.fill(Vector3d::Zero());
  none.length = 0;
  HandSkeleton odd = DefaultHand(kRight, 0.19);
  for (std::size_t i = 0; i < odd.origin_in_parent.size(); ++i) {
    odd.origin_in_parent[i] = 0.2 * Vector3d(i % 3 == 0, i % 3 == 1, i % 3 == 2);
  }
  odd.length = 1e9;
  for (const HandSkeleton& hand : {none, odd}) {
    for (int i = 0; i < kFingersPerHand; ++i) {
      const TriangleMesh mesh = FingerMesh(hand, i);
      ExpectClosed(mesh, Name(i));
      for (const Eigen::Vector3f& vertex : mesh.vertices) {
        ASSERT_TRUE(vertex.allFinite() && vertex.norm() < 1) << Name(i);
      }
      for (const Primitive& part : FingerPrimitives(hand, i)) {
        EXPECT_TRUE(part.size.allFinite() && part.center.allFinite() && part.rpy.allFinite());
      }
    }
  }
}

TEST(HandFigure, HasTheSameBonesAndPalmIfMadeOfPrimitives) {
  const HandSkeleton hand = DefaultHand(kLeft, 0.19);
  for (int i = 0; i < kFingersPerHand; ++i) {
    const auto parts = FingerPrimitives(hand, i);
    const Eigen::Quaterniond turn = Eigen::AngleAxisd(parts[0].rpy.z(), Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(parts[0].rpy.y(), Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(parts[0].rpy.x(), Vector3d::UnitX());
    if (i > 0) {
      ASSERT_EQ(parts.size(), 3u) << Name(i);
      EXPECT_LT((turn * Vector3d::UnitZ() - EndOf(hand, i).normalized()).norm(), 1e-9) << Name(i);
      EXPECT_LE(parts[0].size.y(), EndOf(hand, i).norm());
      continue;
    }
    ASSERT_EQ(parts.size(), 1u);
    const TriangleMesh palm = FingerMesh(hand, 0);
    Eigen::AlignedBox3d box;
    for (std::uint32_t v = 0; v < palm.vertices.size(); ++v) {
      box.extend(turn.conjugate() * (Vertex(palm, v) - parts[0].center));
    }
    // The smooth one is thicker at the wrist, and has round ends beyond wrist and knuckles.
    const Vector3d more = box.sizes() - parts[0].size;
    EXPECT_NEAR(more.x(), 0, 0.01);
    EXPECT_NEAR(more.y(), 0, 0.02);
    EXPECT_NEAR(more.z(), 0.04, 0.01);
    EXPECT_LT(box.center().norm(), 0.012);
  }
}

}  // namespace
}  // namespace kinescope::urdf
