#include "core/hand_load_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace kinescope {
namespace {

using Eigen::Vector3d;
using Kind = HandLoadSolid::Kind;

PersonState Person(double right_kg, double left_kg = 0, double both_kg = 0) {
  PersonState person;
  person.model = std::make_shared<PersonModel>();
  person.links[urdf::kRightHand].position = {0.3, -0.25, 0.9};
  person.links[urdf::kLeftHand].position = {0.3, 0.25, 0.9};
  const std::array<double, 2> alone = {right_kg, left_kg};
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    HandForce& hand = person.forces.hands[side];
    hand.shared_kg = both_kg / 2;
    hand.mass_kg = alone[side] + hand.shared_kg;
    const auto& link = person.links[side == urdf::kRight ? urdf::kRightHand : urdf::kLeftHand];
    hand.grip = hand.point = link.position - Vector3d(0, 0, 0.08);
  }
  return person;
}

double VolumeOf(const HandLoadSolid& disc) {
  return M_PI * disc.size.x() * disc.size.x() * disc.size.z();
}

TEST(HandLoadShape, IsAbsentForEmptyHands) { EXPECT_EQ(ShapeOfHandLoad(Person(0)).count, 0u); }

TEST(HandLoadShape, IsAnIronDumbbellAroundTheLoadsCentreInOneHand) {
  const PersonState person = Person(5);
  const HandLoadShape held = ShapeOfHandLoad(person);
  ASSERT_EQ(held.count, 3u);
  const HandLoadSolid& front = held.solids[1];
  const HandLoadSolid& back = held.solids[2];
  EXPECT_NEAR(7800 * (VolumeOf(front) + VolumeOf(back)), 5, 1e-9);
  EXPECT_LT(
      (0.5 * (front.pose.position + back.pose.position) - person.forces.hands[urdf::kRight].point)
          .norm(),
      1e-12);
  const Vector3d axis = front.pose.orientation * Vector3d::UnitZ();
  EXPECT_LT(axis.cross(Vector3d::UnitX()).norm(), 1e-12) << "the bar lies along the thumb";
}

TEST(HandLoadShape, GrowsWithTheMassAndStaysDrawable) {
  double last = 0;
  for (double mass = 0.02; mass <= 100; mass *= 1.7) {
    const HandLoadShape held = ShapeOfHandLoad(Person(mass, mass, mass));
    ASSERT_EQ(held.count, kMaxHandLoadSolids);
    EXPECT_GT(held.solids[1].size.x(), last);
    last = held.solids[1].size.x();
    for (const HandLoadSolid& solid : held.solids) {
      EXPECT_TRUE(solid.size.allFinite());
      EXPECT_GT(solid.size.minCoeff(), 0);
      EXPECT_NEAR(solid.pose.orientation.norm(), 1, 1e-9);
    }
  }
}

TEST(HandLoadShape, ReachesTheCentreOfMassOfATool) {
  PersonState person = Person(2);
  person.forces.hands[urdf::kRight].point += Vector3d(0.2, 0, -0.3);
  const HandLoadShape held = ShapeOfHandLoad(person);
  ASSERT_EQ(held.count, 2u);
  EXPECT_NEAR(held.solids[0].size.z(), std::hypot(0.2, 0.3), 1e-12);
  EXPECT_EQ(held.solids[1].pose.position, person.forces.hands[urdf::kRight].point);
}

TEST(HandLoadShape, IsABoxBetweenTwoHandsAsWideAsTheirDistance) {
  const HandLoadShape held = ShapeOfHandLoad(Person(0, 0, 10));
  ASSERT_EQ(held.count, 1u);
  const HandLoadSolid& box = held.solids[0];
  EXPECT_EQ(box.kind, Kind::kBox);
  EXPECT_LT((box.pose.position - Vector3d(0.3, 0, 0.82)).norm(), 1e-12);
  EXPECT_NEAR(box.size.y(), 0.46, 1e-12);
  const Vector3d across = box.pose.orientation * Vector3d::UnitY();
  EXPECT_LT(across.cross(Vector3d::UnitY()).norm(), 1e-12);
}

}  // namespace
}  // namespace kinescope
