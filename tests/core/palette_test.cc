#include "core/palette.h"

#include <gtest/gtest.h>

#include "urdf/segments.h"
#include "urdf/skeleton.h"

namespace kinescope {
namespace {

PersonModel PersonOf(double height, double mass_kg) {
  PersonModel model;
  model.human.skeleton = urdf::DefaultSkeleton(height);
  model.description.mass_kg = mass_kg;
  return model;
}

TEST(Palette, DistinguishesTheClassesBySizeToo) {
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    double before = 0;
    for (const LoadClass load_class :
         {LoadClass::kUnknown, LoadClass::kLow, LoadClass::kMedium, LoadClass::kHigh}) {
      const double radius = SphereRadius(joint, load_class, PersonOf(1.75, 75));
      EXPECT_GT(radius, 1.15 * before) << urdf::kJoints[static_cast<std::size_t>(joint)].label;
      before = radius;
    }
  }
}

TEST(Palette, ScalesSpheresWithThePerson) {
  EXPECT_DOUBLE_EQ(SphereRadius(urdf::jRightElbow, LoadClass::kLow, PersonOf(1.9, 76)),
                   2 * SphereRadius(urdf::jRightElbow, LoadClass::kLow, PersonOf(0.95, 19)));
}

}  // namespace
}  // namespace kinescope
