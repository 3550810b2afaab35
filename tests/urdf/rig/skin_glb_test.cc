// The built-in skin written as a GLB, and read again as a rigged person of the user's.
#include "urdf/rig/skin_glb.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "tests/urdf/skin_postures.h"
#include "urdf/rig/glb_container.h"
#include "urdf/rig/glb_values.h"
#include "urdf/rig/rig.h"
#include "urdf/rig/rigged_skin.h"
#include "urdf/skin/contact.h"

namespace kinescope::rig {
namespace {

using Eigen::Vector3f;
using skin::PersonSkin;
using skin::SkinTemplate;

// In one colour, so that the triangles keep their order.
std::string Written(const PersonSkin& person, const SkinGlbOptions& options = {}) {
  const SkinTemplate& built_in = skin::BuiltInSkin();
  return WriteSkinGlb(person, built_in,
                      std::vector<SkinTemplate::Color>(built_in.triangles.size(), {184, 176, 166}),
                      options);
}

std::string Written(const urdf::Skeleton& skeleton) {
  return Written(PersonSkin(skin::BuiltInSkin(), {}, skeleton));
}

// Of each vertex of `of`, the one of `among` that is nearest to it, and at most 4 mm away.
std::vector<std::size_t> Nearest(const std::vector<Vector3f>& of,
                                 const std::vector<Vector3f>& among) {
  std::multimap<float, std::size_t> by_height;
  for (std::size_t i = 0; i < among.size(); ++i) by_height.emplace(among[i].z(), i);
  constexpr float kWithin = 0.004f;
  std::vector<std::size_t> nearest;
  for (const Vector3f& p : of) {
    std::size_t best = 0;
    float least = kWithin;
    const auto end = by_height.upper_bound(p.z() + kWithin);
    for (auto i = by_height.lower_bound(p.z() - kWithin); i != end; ++i) {
      const float distance = (among[i->second] - p).norm();
      if (distance < least) {
        least = distance;
        best = i->second;
      }
    }
    EXPECT_LT(least, kWithin) << "a vertex is where none was";
    nearest.push_back(best);
  }
  return nearest;
}

// Largest distance in random postures of vertices that are one in the bind pose, m.
double FarthestInPostures(const PersonSkin& ours, const PersonSkin& read,
                          const urdf::Skeleton& skeleton) {
  const std::vector<std::size_t> same = Nearest(read.rest(), ours.rest());
  double most = 0;
  std::mt19937 random(3);
  for (int posture = 0; posture < 4; ++posture) {
    urdf::JointAngles angles{};
    for (Eigen::Vector3d& joint : angles) {
      for (double& angle : joint) angle = static_cast<double>(random()) / 4294967295.0 - 0.5;
    }
    const urdf::LinkPoses links = urdf::ForwardKinematics(skeleton, {}, angles);
    PersonSkin::Surface a, b;
    ours.Pose(links, {}, a);
    read.Pose(links, {}, b);
    for (std::size_t i = 0; i < same.size(); ++i) {
      most = std::max(most, static_cast<double>((a.positions[same[i]] - b.positions[i]).norm()));
    }
  }
  return most;
}

TEST(SkinGlb, IsTheSameSkinWhenReadAgain) {
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton();
  const SkinTemplate read = SkinOf(ReadRig(Written(skeleton)));
  EXPECT_EQ(read.size(), skin::BuiltInSkin().size());
  EXPECT_EQ(read.triangles.size(), skin::BuiltInSkin().triangles.size());
  EXPECT_EQ(read.colors[0], (SkinTemplate::Color{184, 176, 166, 255}));
  const PersonSkin ours(skin::BuiltInSkin(), {}, skeleton), again(read, {}, skeleton);
  EXPECT_LT(FarthestInPostures(ours, again, skeleton), 0.0005);
}

TEST(SkinGlb, FitsItsOwnPersonAgain) {
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton(1.52);
  const SkinTemplate read = SkinOf(ReadRig(Written(skeleton)));
  const PersonSkin ours(skin::BuiltInSkin(), {}, skeleton), again(read, {}, skeleton);
  EXPECT_LT(FarthestInPostures(ours, again, skeleton), 0.002);
}

// A woman with gloves who squats away from the origin, with the right fist closed.
class PosedSkinGlb : public ::testing::Test {
 protected:
  PosedSkinGlb() {
    urdf::JointAngles angles{};
    for (const int hip : {urdf::jRightHip, urdf::jLeftHip}) angles[urdf::At(hip)].y() = -1.8;
    for (const int knee : {urdf::jRightKnee, urdf::jLeftKnee}) angles[urdf::At(knee)].y() = 1.9;
    angles[urdf::At(urdf::jRightElbow)].y() = -2.2;
    angles[urdf::At(urdf::jLeftShoulder)].x() = 2.4;
    posture_.links = urdf::ForwardKinematics(
        skeleton_, {{3.5, -2, 0.6}, Eigen::Quaterniond(Eigen::AngleAxisd(2, Vector3d::UnitZ()))},
        angles);
    for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
      urdf::FingerAngles bends{};
      for (Vector3d& bend : bends) bend.x() = side == urdf::kRight ? 1.1 : 0;
      fingers_[side] = urdf::CompleteHand(
          hands_[side], posture_.links[urdf::At(urdf::HandSegmentOf(side))], {}, {}, bends);
      posture_.fingers[side] = &fingers_[side];
    }
    person_.Pose(posture_.links, posture_.fingers, surface_);
  }

  // x of the file is y of the world, y is z, z is x.
  static Vector3f InFile(const Vector3f& p) { return {p.y(), p.z(), p.x()}; }

  using Vector3d = Eigen::Vector3d;
  const urdf::Skeleton skeleton_ = urdf::DefaultSkeleton(1.62);
  const std::array<urdf::HandSkeleton, 2> hands_ = {
      urdf::DefaultHand(urdf::kRight, urdf::EndOf(skeleton_, urdf::kRightHand).norm()),
      urdf::DefaultHand(urdf::kLeft, urdf::EndOf(skeleton_, urdf::kLeftHand).norm())};
  const PersonSkin person_{
      skin::BuiltInSkin(), skin::BuildOf(true, 1.62, 62), skeleton_, {&hands_[0], &hands_[1]}};
  std::array<urdf::FingerPoses, 2> fingers_{};
  SkinPosture posture_;
  PersonSkin::Surface surface_;
};

// Viewers blend bones; they do not flatten the flesh in folds.
TEST_F(PosedSkinGlb, ShowsThePostureAtItsPlace) {
  std::vector<bool> is_in_fold(person_.rest().size(), false);
  for (const skin::FoldShape& fold : skin::FoldsOf(person_.bind(), skeleton_.height)) {
    for (const auto& of : VerticesOf(fold, person_.rest(), skin::BuiltInSkin().weights)) {
      is_in_fold[of.vertex] = true;
    }
  }
  EXPECT_LT(std::count(is_in_fold.begin(), is_in_fold.end(), true), 9000);
  const Rig rig = ReadRig(Written(person_, {posture_}));
  const auto& triangles = skin::BuiltInSkin().triangles;
  ASSERT_EQ(rig.triangles.size(), triangles.size());
  float farthest = 0;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      if (is_in_fold[triangles[i][corner]]) continue;
      const Vector3f shown = rig.vertices[rig.triangles[i][corner]].position.cast<float>();
      const Vector3f ours = InFile(surface_.positions[triangles[i][corner]]);
      farthest = std::max(farthest, (shown - ours).norm());
    }
  }
  EXPECT_LT(farthest, 0.0001f);  // m
}

TEST_F(PosedSkinGlb, KeepsTheBindPoseAtThePlaceOfThePerson) {
  const std::string posed = Written(person_, {posture_});
  const auto json = urdf::ParseGlbJson(urdf::SplitGlb(posed).json);
  const Accessor positions(json, urdf::SplitGlb(posed).binary,
                           json["meshes"][0]["primitives"][0]["attributes"]["POSITION"], "VEC3");
  ASSERT_EQ(positions.count(), person_.rest().size());
  const Vector3f pelvis = posture_.links[urdf::kPelvis].position.cast<float>();
  for (std::size_t i = 0; i < positions.count(); ++i) {
    const Vector3f at = InFile(person_.rest()[i] + pelvis);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ASSERT_NEAR(positions.Number(i, axis), at[static_cast<Eigen::Index>(axis)], 1e-5);
    }
  }
}

TEST_F(PosedSkinGlb, HasThePosedSurfaceItselfWithoutASkeleton) {
  const std::string plain = Written(person_, {posture_, false});
  const auto json = urdf::ParseGlbJson(urdf::SplitGlb(plain).json);
  EXPECT_FALSE(json.contains("skins"));
  EXPECT_EQ(json["nodes"].size(), 1u);
  const auto& part = json["meshes"][0]["primitives"][0]["attributes"];
  EXPECT_EQ(part.size(), 2u) << part;
  const Accessor positions(json, urdf::SplitGlb(plain).binary, part["POSITION"], "VEC3");
  const Accessor normals(json, urdf::SplitGlb(plain).binary, part["NORMAL"], "VEC3");
  ASSERT_EQ(positions.count(), surface_.positions.size());
  for (std::size_t i = 0; i < positions.count(); ++i) {
    const Vector3f at = InFile(surface_.positions[i]), normal = InFile(surface_.normals[i]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<Eigen::Index>(axis);
      ASSERT_NEAR(positions.Number(i, axis), at[k], 1e-5);
      ASSERT_NEAR(normals.Number(i, axis), normal[k], 1e-5);
    }
  }
}

}  // namespace
}  // namespace kinescope::rig
