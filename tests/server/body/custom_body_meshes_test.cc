#include "server/body/custom_body_meshes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "core/system/errors.h"
#include "server/scene/scene_options.h"
#include "tests/server/options_testing.h"
#include "tests/shared_data.h"
#include "tests/temp_folder.h"
#include "urdf/body_surface.h"

namespace kinescope::app {
namespace {

using ::testing::HasSubstr;
using urdf::At;

TEST(CustomBodyMeshes, AreRecognisedByCommonFileNames) {
  const auto expect = [](std::initializer_list<const char*> stems, urdf::Segment segment) {
    for (const char* stem : stems) EXPECT_EQ(SegmentOfFile(stem), segment) << stem;
  };
  expect({"RightForeArm", "xsens_RightForeArm", "right_forearm", "rightforearm", "forearm_r",
          "R_ForeArm", "ForeArm.R", "Forearm-Right", "RIGHT_FOREARM", "xsens_right_fore_arm"},
         urdf::kRightForeArm);
  expect({"LeftUpperLeg", "left_upper_leg", "upperleg_l", "L-UpperLeg"}, urdf::kLeftUpperLeg);
  expect({"T8", "t8", "xsens_T8"}, urdf::kT8);
  expect({"L5", "l5"}, urdf::kL5);
  expect({"Head", "head"}, urdf::kHead);
  for (const char* stem :
       {"", "xsens", "ForeArm", "RightHeel", "right_left_hand", "Sofa", "T9", "left_left_toe"}) {
    EXPECT_FALSE(SegmentOfFile(stem)) << stem;
  }
}

class MeshFolder : public ::testing::Test {
 protected:
  // A square rod along -z, as an OBJ in units of `unit` metres.
  void WriteRod(const std::string& name, double length, double unit = 1) {
    std::ofstream file(folder_ / name);
    for (int i = 0; i < 8; ++i) {
      file << "v " << ((i & 1) != 0 ? 0.03 : -0.03) / unit << ' '
           << ((i & 2) != 0 ? 0.03 : -0.03) / unit << ' ' << ((i & 4) != 0 ? 0 : -length / unit)
           << '\n';
    }
    file << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  }
  std::string Path() const { return folder_.path().string(); }
  std::string ErrorOf(const urdf::MeshConvention& convention = {}) const {
    try {
      ReadCustomBodyMeshes(Path(), convention);
    } catch (const UsageError& error) {
      return error.what();
    }
    return "";
  }

  testing::TempFolder folder_;
};

TEST_F(MeshFolder, ProvidesFittedCustomMeshesAndBuiltInMeshesForTheRest) {
  WriteRod("left_lower_leg.obj", 0.400, 0.001);
  urdf::MeshConvention convention;
  convention.metres_per_unit = 0.001;
  const auto figure = ReadCustomBodyMeshes(Path(), convention);
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton(1.9);
  const auto shank = BodyMeshOf(figure.get(), skeleton, urdf::kLeftLowerLeg);
  EXPECT_EQ(shank.triangles.size(), 12U);
  const Eigen::AlignedBox3d box = urdf::BoundsOf(shank);
  EXPECT_NEAR(box.min().z(), urdf::EndOf(skeleton, urdf::kLeftLowerLeg).z(), 1e-6);
  EXPECT_NEAR(box.max().z(), 0, 1e-6);
  EXPECT_NEAR(box.sizes().x(), 0.06, 1e-6);
  EXPECT_EQ(BodyMeshOf(figure.get(), skeleton, urdf::kHead).triangles.size(),
            urdf::SegmentMesh(skeleton, urdf::kHead).triangles.size());

  convention.fits_person = false;
  const auto as_it_is = ReadCustomBodyMeshes(Path(), convention);
  EXPECT_NEAR(urdf::BoundsOf(BodyMeshOf(as_it_is.get(), skeleton, urdf::kLeftLowerLeg)).min().z(),
              -0.4, 1e-6);
}

TEST_F(MeshFolder, IsRejectedWithTheReasonIfItIsNoBodyModel) {
  EXPECT_THAT(ErrorOf(), HasSubstr("no mesh file with a segment name found"));
  WriteRod("Sofa.obj", 0.4);
  EXPECT_THAT(ErrorOf(), HasSubstr("no mesh file with a segment name found"));
  WriteRod("Head.obj", 400);
  EXPECT_THAT(ErrorOf(), ::testing::AllOf(HasSubstr("Head.obj"), HasSubstr("mesh_units")));
  std::ofstream(folder_ / "Head.obj") << "v 0 0 0\n";
  EXPECT_THAT(ErrorOf(), HasSubstr("Head.obj"));
  WriteRod("Head.obj", 0.2);
  EXPECT_EQ(ErrorOf(), "");
  WriteRod("xsens_Head.obj", 0.2);
  EXPECT_THAT(ErrorOf(), ::testing::AllOf(HasSubstr("Head.obj and xsens_Head.obj"),
                                          HasSubstr("both meshes of Head")));
  EXPECT_THROW(ReadCustomBodyMeshes(Path() + "/nowhere", {}), UsageError);
}

TEST_F(MeshFolder, IsSelectedByOptions) {
  WriteRod("Head.obj", 0.2);
  const auto person = testing::With<PersonOptions>({{"body_model", "mesh:" + Path()}});
  EXPECT_NE(ToSceneOptions(person).appearance.custom, nullptr);
  EXPECT_THAT(person.body_model.Files(), ::testing::ElementsAre(Path() + "/Head.obj"));
  for (const auto& [name, text] : testing::Settings{{"mesh_units", "inch"},
                                                    {"mesh_up", "x"},
                                                    {"mesh_scale", "2"},
                                                    {"mesh_frame", "world"},
                                                    {"body_model", "mesh:"},
                                                    {"body_model", "pretty"}}) {
    EXPECT_NE(testing::ErrorOfSetting<PersonOptions>(name, text), "") << text;
  }
  EXPECT_THROW(
      ToSceneOptions(testing::With<PersonOptions>({{"body_model", "mesh:/nowhere/at/all"}})),
      UsageError);
}

// The surface of a person of the set, in link frames at the N-pose: about as large as a person.
TEST(CustomBodyMeshes, OfPublishedSetsFitThePerson) {
  KINESCOPE_NEEDS_SHARED_DATA("models/human-model-generator/meshes");
  const auto figure =
      ReadCustomBodyMeshes(testing::SharedData("models/human-model-generator/meshes").string(), {});
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton(1.82);
  const auto origins = urdf::NPoseOrigins(skeleton);
  Eigen::AlignedBox3d person;
  for (int i = 0; i < urdf::kSegmentCount; ++i) {
    ASSERT_TRUE(figure->meshes[At(i)]) << urdf::kSegments[At(i)].mvn_name;
    const auto mesh = BodyMeshOf(figure.get(), skeleton, i);
    Eigen::AlignedBox3d box = urdf::BoundsOf(mesh);
    person.extend(box.translate(origins[At(i)]));
  }
  EXPECT_NEAR(person.min().z(), 0, 1e-3);
  EXPECT_NEAR(person.max().z(), 1.82, 0.02);
  EXPECT_NEAR(person.sizes().y(), 0.50, 0.12) << "arms hang at the sides";
}

}  // namespace
}  // namespace kinescope::app
