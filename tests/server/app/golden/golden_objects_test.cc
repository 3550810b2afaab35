#include "server/app/golden/golden_objects.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

using render::SphereInPicture;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

SphereInPicture Sphere(const std::string& joint, LoadClass load_class, double ratio) {
  SphereInPicture sphere;
  sphere.joint = joint;
  sphere.load_class = load_class;
  sphere.ratio = ratio;
  sphere.x_px = 100.04;
  sphere.y_px = 50;
  sphere.radius_px = 9;
  return sphere;
}

TEST(GoldenObjects, AreReadAsTheyWereWritten) {
  const testing::TempFolder folder;
  const std::vector<SphereInPicture> spheres = {Sphere("right_elbow", LoadClass::kMedium, 0.4321),
                                                Sphere("l5_s1", LoadClass::kUnknown, NAN)};
  std::ofstream(folder.path() / "o.json") << ToJson(spheres);
  EXPECT_THAT(FindObjectChanges(ReadObjects(folder.path() / "o.json"), spheres), IsEmpty());
}

TEST(GoldenObjects, NameTheJointWhoseClassHasChanged) {
  EXPECT_THAT(FindObjectChanges({Sphere("right_elbow", LoadClass::kLow, 0.299)},
                                {Sphere("right_elbow", LoadClass::kMedium, 0.301)}),
              ElementsAre("right_elbow: expected low (green), found medium (orange)"));
}

TEST(GoldenObjects, NameMissingNewMovedAndUnknownObjects) {
  SphereInPicture moved = Sphere("l5_s1", LoadClass::kLow, 0.1);
  moved.x_px += 3;
  SphereInPicture silent = Sphere("left_hip", LoadClass::kLow, NAN);
  EXPECT_THAT(
      FindObjectChanges(
          {Sphere("l5_s1", LoadClass::kLow, 0.1), Sphere("left_hip", LoadClass::kLow, 0.1),
           Sphere("left_knee", LoadClass::kLow, 0.1)},
          {moved, silent, Sphere("t9_t8", LoadClass::kHigh, 0.9)}),
      ElementsAre("l5_s1: moved by 3.0 px", "left_hip: its load is now unknown",
                  "left_knee: load sphere is missing", "t9_t8: new load sphere, high (red)"));
}

TEST(GoldenObjects, NameADamagedFile) {
  const testing::TempFolder folder;
  const auto path = folder.path() / "o.json";
  std::ofstream(path) << "{\"spheres\": [{}]}";
  try {
    ReadObjects(path);
    FAIL() << "accepted a sphere without a joint";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace kinescope::app
