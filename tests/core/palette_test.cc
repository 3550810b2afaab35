#include "core/palette.h"

#include <gtest/gtest.h>

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

TEST(Palette, ScalesSpheresWithThePerson) {
  EXPECT_DOUBLE_EQ(SphereRadius(urdf::jRightElbow, LoadClass::kLow, 3.5),
                   2 * SphereRadius(urdf::jRightElbow, LoadClass::kLow, 1.75));
}

}  // namespace
}  // namespace kinescope
