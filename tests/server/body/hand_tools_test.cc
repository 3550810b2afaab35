#include "server/body/hand_tools.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "core/hand_load_shape.h"
#include "core/system/errors.h"
#include "server/loads/hand_loads.h"
#include "server/scene/scene_builder.h"
#include "server/scene/scene_options.h"
#include "server/scene/scene_reader.h"
#include "tests/server/options_testing.h"
#include "tests/temp_folder.h"
#include "urdf/robot/robot_model.h"

namespace kinescope::app {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;
using urdf::kLeft;
using urdf::kRight;

class HandToolsTest : public ::testing::Test {
 protected:
  // A drill of 0.2 m along x, whose origin is where it is held.
  HandToolsTest() { WriteBar("drill.obj", 1); }

  void WriteBar(const char* name, double unit) {
    std::ofstream file(folder_ / name);
    for (int i = 0; i < 8; ++i) {
      file << "v " << ((i & 1) != 0 ? 0.17 : -0.03) / unit << ' '
           << ((i & 2) != 0 ? 0.02 : -0.02) / unit << ' ' << ((i & 4) != 0 ? 0.02 : -0.02) / unit
           << '\n';
    }
    file << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  }
  std::string Drill() const { return (folder_ / "drill.obj").string(); }
  static std::shared_ptr<const HandTools> Read(const std::string& text,
                                               const urdf::MeshConvention& convention = {}) {
    ToolsValue files;
    files.Parse(text);
    return ReadHandTools(files, convention);
  }
  static std::string ErrorOf(const std::string& text) {
    try {
      Read(text);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }

  testing::TempFolder folder_;
};

TEST_F(HandToolsTest, PutsToolsAtTheGripByDefault) {
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton(1.75);
  const auto tools = Read("right:" + Drill() + ";left:" + Drill() + "@0.1,0.2,-0.3");
  const auto right = urdf::BoundsOf(ToHandFrame(*(*tools)[kRight], skeleton, kRight));
  const Vector3d grip = urdf::GripPoint(skeleton, kRight);
  EXPECT_LT((right.min() - (grip + Vector3d(-0.03, -0.02, -0.02))).norm(), 1e-6);
  EXPECT_LT((right.max() - (grip + Vector3d(0.17, 0.02, 0.02))).norm(), 1e-6);
  const auto left = urdf::BoundsOf(ToHandFrame(*(*tools)[kLeft], skeleton, kLeft));
  EXPECT_LT((left.max() - Vector3d(0.27, 0.22, -0.28)).norm(), 1e-6);
  EXPECT_EQ(Read(""), nullptr);
}

TEST_F(HandToolsTest, RotatesToolsLikeAUrdf) {
  // Pitched by 90 degrees, what pointed forward points down.
  const auto tools = Read("right:" + Drill() + "@0,0,0,0,1.5707963267948966,0");
  const auto box =
      urdf::BoundsOf(ToHandFrame(*(*tools)[kRight], urdf::DefaultSkeleton(1.75), kRight));
  EXPECT_NEAR(box.min().z(), -0.17, 1e-6);
  EXPECT_NEAR(box.max().z(), 0.03, 1e-6);
}

TEST_F(HandToolsTest, AppliesTheUnitOfTheFiles) {
  WriteBar("drill_mm.obj", 0.001);
  urdf::MeshConvention millimetres;
  millimetres.metres_per_unit = 0.001;
  const auto tools = Read("left:" + (folder_ / "drill_mm.obj").string(), millimetres);
  EXPECT_NEAR(urdf::BoundsOf((*tools)[kLeft]->mesh).sizes().x(), 0.2, 1e-6);
  EXPECT_THAT(ErrorOf("left:" + (folder_ / "drill_mm.obj").string()), HasSubstr("--mesh_units"));
}

TEST_F(HandToolsTest, RejectsInvalidToolsWithTheExpectedFormat) {
  for (const std::string& bad :
       {"nose:" + Drill(), Drill(), std::string("right:"), "right:" + Drill() + "@1,2",
        "right:" + Drill() + "@0,nan,0", "right:" + Drill() + "@3,0,0"}) {
    EXPECT_THAT(ErrorOf(bad), HasSubstr("right:FILE or left:FILE")) << bad;
  }
  EXPECT_THAT(ErrorOf("right:" + Drill() + ";right:" + Drill()), HasSubstr("two tools"));
  EXPECT_THAT(ErrorOf("right:" + (folder_ / "none.stl").string()), HasSubstr("none.stl"));
}

// One option, and URDF, pictures, page and RViz have it: they all read the person's URDF.
TEST_F(HandToolsTest, AddsToolsToTheUrdfInsteadOfTheDumbbell) {
  const auto person = testing::With<PersonOptions>({{"tool", "right:" + Drill()}});
  const auto loads = testing::With<LoadOptions>({{"hand_load", "right:5,left:5"}});
  const testing::TempFolder cache;
  SceneOptions options = ToSceneOptions(person, loads);
  options.mesh_cache = std::make_shared<const MeshCache>(cache.path());
  SceneReader reader("demo:n_pose", options);
  const auto scene = reader.Next();
  ASSERT_TRUE(scene);
  const PersonState& state = scene->people.front();
  std::vector<std::string> hand_meshes;
  for (const urdf::Link& link : state.model->robot.links) {
    for (const urdf::Visual& visual : link.visuals) {
      if (link.name == "skeleton_right_hand") hand_meshes.push_back(visual.geometry.mesh_uri);
    }
  }
  ASSERT_EQ(hand_meshes.size(), 2U);
  EXPECT_THAT(hand_meshes[1], HasSubstr("/right_tool.stl"));
  EXPECT_THAT(cache.Names(), ::testing::IsEmpty()) << "before a sink asks for the files";
  ASSERT_TRUE(state.model->mesh_files->Provide());
  EXPECT_TRUE(std::filesystem::exists(hand_meshes[1].substr(std::string("file://").size())));

  const HandLoadShape held = ShapeOfHandLoad(state);
  ASSERT_GT(held.count, 0U);  // of the left hand
  for (std::size_t i = 0; i < held.count; ++i) {
    const Vector3d& left = state.links[urdf::kLeftHand].position;
    EXPECT_LT((held.solids[i].pose.position - left).norm(), 0.3);
  }
}

}  // namespace
}  // namespace kinescope::app
