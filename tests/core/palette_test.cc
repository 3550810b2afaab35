#include "core/palette.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "urdf/skin/person_skin.h"

namespace kinescope {
namespace {

TEST(Palette, DistinguishesTheClassesBySizeToo) {
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    double before = 0;
    for (const LoadClass load_class :
         {LoadClass::kUnknown, LoadClass::kLow, LoadClass::kMedium, LoadClass::kHigh}) {
      const double radius = SphereRadius(joint, load_class, 1.75);
      EXPECT_GT(radius, 1.15 * before) << urdf::kJoints[static_cast<std::size_t>(joint)].label;
      before = radius;
    }
  }
}

// Half of the least width of the left limb's section at the joint, in the bind pose, m.
double HalfThickness(const skin::PersonSkin& skin, int joint) {
  const urdf::Pose& link = skin.bind().links[urdf::At(urdf::ChildOf(joint))];
  std::vector<Eigen::Vector3d> section;
  for (const Eigen::Vector3f& vertex : skin.rest()) {
    const Eigen::Vector3d p = skin::InLink(link, vertex.cast<double>());
    if (std::abs(p.z()) < 0.006 && p.head<2>().norm() < 0.1) section.push_back(p);
  }
  double least = 1;
  for (int step = 0; step < 36; ++step) {
    const double angle = step * M_PI / 36;
    const Eigen::Vector3d across(std::cos(angle), std::sin(angle), 0);
    double from = 1, to = -1;
    for (const Eigen::Vector3d& p : section) {
      from = std::min(from, across.dot(p));
      to = std::max(to, across.dot(p));
    }
    least = std::min(least, (to - from) / 2);
  }
  return least;
}

TEST(Palette, HasNoSphereWiderThanTheLimbAroundIt) {
  const skin::PersonSkin man(skin::BuiltInSkin(), {}, urdf::DefaultSkeleton());
  for (const int joint : {urdf::jLeftElbow, urdf::jLeftWrist, urdf::jLeftKnee, urdf::jLeftAnkle}) {
    EXPECT_LE(SphereRadius(joint, LoadClass::kHigh, 1.75), 1.02 * HalfThickness(man, joint))
        << urdf::kJoints[urdf::At(joint)].label;
  }
}

TEST(Palette, ScalesSpheresWithThePerson) {
  EXPECT_DOUBLE_EQ(SphereRadius(urdf::jRightElbow, LoadClass::kLow, 3.5),
                   2 * SphereRadius(urdf::jRightElbow, LoadClass::kLow, 1.75));
}

}  // namespace
}  // namespace kinescope
