// The skin moves as the measured person does: about the measured joint centres, and a limb that is
// turned about its own axis stays about as thick as it was.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/urdf/skin_postures.h"

namespace kinescope::skin {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3f;
using urdf::At;

std::vector<Vector3f> Posed(const PersonSkin& skin, const urdf::LinkPoses& links) {
  PersonSkin::Surface surface;
  skin.Pose(links, {}, surface);
  return surface.positions;
}

struct Fit {
  Vector3d center = Vector3d::Zero();
  double worst_residual = 0;  // of a vertex from the rigid motion, m
};

// The point about which the skin of a limb turns: that which all turns leave where it is. Takes the
// skin between 8 and 20 cm past the joint, and knows nothing of frames.
Fit CenterOfRotation(const PersonSkin& skin, int joint) {
  const int child = urdf::ChildOf(joint);
  const urdf::Pose& link = skin.bind().links[At(child)];
  const Vector3d axes[] = {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d(1, 1, 0).normalized()};
  std::vector<std::size_t> limb;
  for (std::size_t i = 0; i < skin.rest().size(); ++i) {
    const Vector3d p = InLink(link, skin.rest()[i].cast<double>());
    if (p.z() < -0.08 && p.z() > -0.20 && p.head<2>().norm() < 0.11 && skin.rest()[i].y() > 0.01f) {
      limb.push_back(i);
    }
  }
  Eigen::Matrix3Xd from(3, limb.size()), to(3, limb.size());
  for (std::size_t i = 0; i < limb.size(); ++i) {
    from.col(static_cast<Eigen::Index>(i)) = skin.rest()[limb[i]].cast<double>();
  }
  Fit fit;
  Matrix3d sum = Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  for (const Vector3d& axis : axes) {
    for (const double degrees : {-40.0, 40.0}) {
      const auto posed = Posed(skin, TurnedAt(skin.bind().links, joint, axis, degrees));
      for (std::size_t i = 0; i < limb.size(); ++i) {
        to.col(static_cast<Eigen::Index>(i)) = posed[limb[i]].cast<double>();
      }
      const Eigen::Matrix4d motion = Eigen::umeyama(from, to, false);
      const Matrix3d turn = motion.topLeftCorner<3, 3>();
      const Vector3d move = motion.topRightCorner<3, 1>();
      const double residual = ((turn * from).colwise() + move - to).colwise().norm().maxCoeff();
      fit.worst_residual = std::max(fit.worst_residual, residual);
      const Matrix3d leaves = Matrix3d::Identity() - turn;  // leaves * center = move
      sum += leaves.transpose() * leaves;
      right += leaves.transpose() * move;
    }
  }
  fit.center = sum.ldlt().solve(right);
  return fit;
}

TEST(SkinMotion, TurnsAboutTheMeasuredJointCentres) {
  urdf::Skeleton uneven = urdf::DefaultSkeleton(1.80);
  uneven.origin_in_parent[urdf::kLeftForeArm].z() *= 1.15;
  uneven.origin_in_parent[urdf::kLeftLowerLeg].z() *= 0.88;
  uneven.origin_in_parent[urdf::kLeftUpperLeg].y() *= 1.2;
  for (const urdf::Skeleton& skeleton : {urdf::DefaultSkeleton(1.50), urdf::DefaultSkeleton(1.75),
                                         urdf::DefaultSkeleton(2.05), uneven}) {
    const PersonSkin skin(BuiltInSkin(), BuildOf(false, skeleton.height, 75), skeleton);
    for (const int joint : {urdf::jLeftElbow, urdf::jLeftKnee}) {
      const int child = urdf::ChildOf(joint);
      const Fit fit = CenterOfRotation(skin, joint);
      EXPECT_LT((fit.center - skin.bind().links[At(child)].position).norm(), 0.002)
          << urdf::kJoints[At(joint)].label << " at a stature of " << skeleton.height << " m";
      EXPECT_LT(fit.worst_residual, 0.010) << "this skin does not move as a limb";
    }
  }
}

// Of the section of a left arm across its bone, m^2.
double SectionArea(const PersonSkin& skin, const std::vector<Vector3f>& positions,
                   const urdf::Pose& link, double along) {
  double area = 0;
  for (const Triangle& t : skin.triangles()) {
    std::vector<Vector3d> crossings;
    for (std::size_t side = 0; side < 3; ++side) {
      const Vector3d a = InLink(link, positions[t[side]].cast<double>());
      const Vector3d b = InLink(link, positions[t[(side + 1) % 3]].cast<double>());
      if ((a.z() < along) == (b.z() < along)) continue;
      const Vector3d p = a + (along - a.z()) / (b.z() - a.z()) * (b - a);
      if (a.z() < along) {
        crossings.push_back(p);
      } else {
        crossings.insert(crossings.begin(), p);
      }
    }
    if (crossings.size() != 2 || crossings[0].head<2>().norm() > 0.10) continue;
    const Vector3d &a = crossings[0], &b = crossings[1];
    area += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  return std::abs(area);
}

// The smallest section of the bone of `segment` as a share of what it was, from `from` of its
// length.
double ThinnestSection(const PersonSkin& skin, int joint, double degrees, double from) {
  const int segment = urdf::ChildOf(joint);
  const urdf::LinkPoses turned = TurnedAt(skin.bind().links, joint, Vector3d::UnitZ(), degrees);
  const auto posed = Posed(skin, turned);
  const double length =
      (skin.bind().links[At(segment + 1)].position - skin.bind().links[At(segment)].position)
          .norm();
  double thinnest = 9;
  for (double share = from; share < 0.92; share += 0.04) {
    const double rest =
        SectionArea(skin, skin.rest(), skin.bind().links[At(segment)], -share * length);
    const double now = SectionArea(skin, posed, turned[At(segment)], -share * length);
    EXPECT_GT(rest, 0.0008) << share;
    thinnest = std::min(thinnest, now / rest);
  }
  return thinnest;
}

TEST(SkinMotion, KeepsALimbThickThatIsTurnedAboutItsOwnAxis) {
  for (const bool is_woman : {false, true}) {
    const PersonSkin skin = SkinOf(is_woman, 1.75, is_woman ? 72.4 : 75);
    for (const double sign : {-1.0, 1.0}) {
      const std::string who = std::string(is_woman ? "woman " : "man ") + (sign < 0 ? "in" : "out");
      EXPECT_GE(ThinnestSection(skin, urdf::jLeftElbow, sign * 150, 0.12), 0.93) << who;
      // Above, the section is also that of the armpit.
      EXPECT_GE(ThinnestSection(skin, urdf::jLeftShoulder, sign * 110, 0.36), 0.94) << who;
    }
  }
}

}  // namespace
}  // namespace kinescope::skin
