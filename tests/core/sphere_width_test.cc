// Load spheres beside the limbs that they sit on, measured on the skin at rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/palette.h"
#include "core/skin_inputs.h"
#include "urdf/skin/person_skin.h"

namespace kinescope {
namespace {

// Of a body 1.75 m tall, m.
struct Limb {
  int joint;
  double along;              // of the section, in the child's link frame
  double reach;              // to which the section belongs to the limb
  bool is_at_sphere = true;  // the sphere's own section there; else the whole sphere is compared
};
// Neck, upper arm and thigh are compared where they are beside their joints, which lie in the
// trunk.
constexpr Limb kLimbs[] = {
    {urdf::jL5S1, 0, 0.25},
    {urdf::jT9T8, 0, 0.25},
    {urdf::jT1C7, 0.08, 0.11, false},
    {urdf::jLeftShoulder, -0.12, 0.11, false},
    {urdf::jLeftElbow, 0, 0.10},
    {urdf::jLeftElbow, 0.02, 0.10},
    {urdf::jLeftWrist, 0, 0.10},
    {urdf::jLeftWrist, 0.01, 0.10},
    {urdf::jLeftHip, -0.16, 0.20, false},
    {urdf::jLeftKnee, 0, 0.12},
    {urdf::jLeftKnee, -0.02, 0.12},
    {urdf::jLeftAnkle, 0, 0.10},
    {urdf::jLeftAnkle, 0.017, 0.10},
};

// Half of the least width of the section, m. The outline itself is cut, not its corners.
double HalfWidth(const skin::PersonSkin& skin, const Limb& limb, double size) {
  const urdf::Pose& link = skin.bind().links[urdf::At(urdf::ChildOf(limb.joint))];
  const bool is_in_the_middle = link.position.y() < 0.01;
  const double along = size * limb.along;
  std::vector<Eigen::Vector2d> section;
  std::vector<std::optional<Eigen::Vector3d>> near(skin.rest().size());
  for (std::size_t i = 0; i < near.size(); ++i) {
    const Eigen::Vector3d p = skin.rest()[i].cast<double>();
    if (!is_in_the_middle && p.y() < 0.002) continue;  // the other side of the body
    if ((p - link.position).squaredNorm() < 0.09) near[i] = skin::InLink(link, p);
  }
  for (const skin::Triangle& t : skin.triangles()) {
    for (std::size_t side = 0; side < 3; ++side) {
      const auto& a = near[t[side]];
      const auto& b = near[t[(side + 1) % 3]];
      if (!a || !b || !(a->z() < along && b->z() >= along)) continue;
      const Eigen::Vector3d p = *a + (along - a->z()) / (b->z() - a->z()) * (*b - *a);
      if (p.head<2>().norm() < size * limb.reach) section.emplace_back(p.x(), p.y());
    }
  }
  EXPECT_GT(section.size(), 15U) << urdf::kJoints[urdf::At(limb.joint)].label;
  double least = 1;
  for (int step = 0; step < 45; ++step) {
    const double angle = step * M_PI / 45;
    const Eigen::Vector2d across(std::cos(angle), std::sin(angle));
    double from = 1, to = -1;
    for (const Eigen::Vector2d& p : section) {
      from = std::min(from, across.dot(p));
      to = std::max(to, across.dot(p));
    }
    least = std::min(least, (to - from) / 2);
  }
  return least;
}

PersonModel Person(urdf::Sex sex, double height, double mass) {
  PersonModel model;
  model.human.skeleton = urdf::DefaultSkeleton(height);
  model.description.sex = sex;
  model.description.mass_kg = mass;
  return model;
}

TEST(LoadSpheres, AreNeverWiderThanTheLimbThatTheySitOn) {
  using urdf::Sex;
  for (const PersonModel& person :
       {Person(Sex::kMale, 1.75, 75), Person(Sex::kMale, 1.85, 55), Person(Sex::kMale, 1.80, 66),
        Person(Sex::kMale, 1.75, 110), Person(Sex::kFemale, 1.62, 62),
        Person(Sex::kFemale, 1.70, 48), Person(Sex::kFemale, 1.66, 58),
        Person(Sex::kFemale, 1.62, 100), Person(Sex::kFemale, 1.20, 25)}) {
    const double height = person.human.skeleton.height;
    const double size = height / urdf::kReferenceHeight;
    const skin::PersonSkin skin(skin::BuiltInSkin(), BuildOf(person), person.human.skeleton);
    for (const Limb& limb : kLimbs) {
      const double radius = SphereRadius(limb.joint, LoadClass::kHigh, person);
      const double away = limb.is_at_sphere ? size * limb.along : 0;
      constexpr double kRounding = 1e-4;  // m; positions of the skin have steps of 0.06 mm
      EXPECT_LE(std::sqrt(radius * radius - away * away), HalfWidth(skin, limb, size) + kRounding)
          << urdf::kJoints[urdf::At(limb.joint)].label << " of a "
          << (person.description.sex == Sex::kMale ? "man" : "woman") << " of " << height << " m, "
          << person.description.mass_kg << " kg, at " << limb.along << " m";
    }
  }
}

}  // namespace
}  // namespace kinescope
