// Folds of elbows, knees and hips: flesh that meets flattens, without a jump at any angle.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "tests/urdf/skin_postures.h"
#include "urdf/skin/contact.h"

namespace kinescope::skin {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using urdf::At;

struct Fold {
  int joint;
  Vector3d axis;  // of the child link
};
const Fold kFoldsOfLeft[] = {{urdf::jLeftElbow, -Vector3d::UnitY()},
                             {urdf::jLeftHip, -Vector3d::UnitY()},
                             {urdf::jLeftKnee, Vector3d::UnitY()}};

TEST(SkinContact, ChangesNothingAtSmallBends) {
  EXPECT_EQ(kContact.At(std::cos(60 * kDegree)), 0);
  EXPECT_EQ(kContact.At(std::cos(90 * kDegree)), 1);
  for (const FoldShape& fold : FoldsOf(BindPoseOf(urdf::DefaultSkeleton()), 1.75)) {
    EXPECT_EQ(fold.bulges.At(std::cos(60 * kDegree)), 0)
        << urdf::kSegments[At(fold.segment)].link_name;
  }
}

TEST(SkinContact, TakesBothSidesOfEachFoldAndNothingElse) {
  const PersonSkin skin = SkinOf(true, 1.62, 62);
  for (const FoldShape& fold : FoldsOf(skin.bind(), 1.62)) {
    int of_parent = 0, of_child = 0;
    for (const FoldVertex& of : VerticesOf(fold, skin.rest(), BuiltInSkin().weights)) {
      (of.side > 0 ? of_parent : of_child) += std::abs(of.side) > 0.9f ? 1 : 0;
      ASSERT_LE(std::abs(of.side), 1);
      ASSERT_LE(of.floor, 0);
      const Vector3d p = skin.rest()[of.vertex].cast<double>();
      ASSERT_LT((p - fold.center).norm(), 0.55) << urdf::kSegments[At(fold.segment)].link_name;
    }
    EXPECT_GT(std::min(of_parent, of_child), 40) << urdf::kSegments[At(fold.segment)].link_name;
  }
}

// On the hollow side of the bent joint, as much of the limbs lies within the other as may.
TEST(SkinContact, KeepsFleshOnItsSideOfTheFold) {
  const PersonSkin skin = SkinOf(false, 1.75, 75);
  const FoldShape fold = FoldsOf(skin.bind(), 1.75)[5];
  ASSERT_EQ(fold.segment, urdf::kLeftLowerLeg);
  PersonSkin::Surface surface;
  const urdf::LinkPoses links =
      TurnedAt(skin.bind().links, urdf::jLeftKnee, Vector3d::UnitY(), 150);
  skin.Pose(links, {}, surface);
  const urdf::Pose& thigh = links[urdf::kLeftUpperLeg];
  const urdf::Pose& shank = links[urdf::kLeftLowerLeg];
  const Vector3d normal =
      (thigh.orientation * Vector3d::UnitZ() + shank.orientation * Vector3d::UnitZ()).normalized();
  double farthest = 0;
  for (const FoldVertex& of : VerticesOf(fold, skin.rest(), BuiltInSkin().weights)) {
    if (std::abs(of.side) < 0.99f) continue;
    const double before = normal.dot(surface.positions[of.vertex].cast<double>() - shank.position);
    farthest = std::max(farthest, of.side > 0 ? -before : before);
  }
  EXPECT_GT(farthest, 0.002) << "nothing meets";
  EXPECT_LT(farthest, 0.013) << "m past the plane";
}

TEST(SkinContact, MovesSmoothlyWithTheAngle) {
  const PersonSkin skin = SkinOf(false, 1.75, 75);
  constexpr double kStep = 0.5, kReach = 0.25;  // degrees, m around the joint
  for (const Fold& fold : kFoldsOfLeft) {
    const Vector3f center = skin.bind().links[At(urdf::ChildOf(fold.joint))].position.cast<float>();
    PersonSkin::Surface before, now;
    skin.Pose(TurnedAt(skin.bind().links, fold.joint, fold.axis, 50), {}, before);
    for (double degrees = 50 + kStep; degrees <= 160; degrees += kStep) {
      skin.Pose(TurnedAt(skin.bind().links, fold.joint, fold.axis, degrees), {}, now);
      float farthest = 0;
      for (std::size_t i = 0; i < now.positions.size(); ++i) {
        if ((skin.rest()[i] - center).norm() > kReach) continue;
        farthest = std::max(farthest, (now.positions[i] - before.positions[i]).norm());
      }
      // A rigid part at this distance moves by 1 of these.
      EXPECT_LT(farthest / (kReach * kStep * kDegree), 1.5) << degrees << " degrees";
      std::swap(before, now);
    }
  }
}

}  // namespace
}  // namespace kinescope::skin
