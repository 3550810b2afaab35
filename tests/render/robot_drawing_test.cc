// Robots of any kind, tested by what the picture shows.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <regex>

#include "core/scene_extent.h"
#include "render/image/compare.h"
#include "render/renderer.h"
#include "tests/render/test_scene.h"
#include "tests/shared_data.h"
#include "tests/temp_folder.h"
#include "tests/urdf/mesh_samples.h"
#include "urdf/robot/robot_kinematics.h"

namespace kinescope::render {
namespace {

using kinescope::testing::BoxStl;
using kinescope::testing::TempFolder;
using ::testing::HasSubstr;

constexpr int kWidth = 640, kHeight = 360;

class RobotDrawing : public ::testing::Test {
 protected:
  RobotDrawing()
      : renderer_(
            MakeRenderer("osmesa", [this](const std::string& line) { log_.push_back(line); })) {
    spec_.width = kWidth;
    spec_.height = kHeight;
    spec_.overlays = false;
  }

  RobotState Robot(const std::string& xml, const urdf::JointPositions& positions = {}) {
    RobotState robot;
    robot.model = std::make_shared<urdf::RobotModel>(urdf::ParseUrdf(xml));
    robot.name = robot.model->name;
    robot.meshes = std::make_shared<urdf::MeshSearch>(urdf::MakeMeshSearch(folder_ / "r.urdf", {}));
    robot.world_from_link = urdf::PlaceLinks(*robot.model, positions);
    return robot;
  }

  // One link with one visual, whose text is given.
  RobotState Visual(const std::string& visual) {
    return Robot("<robot name='r'><link name='a'><visual>" + visual + "</visual></link></robot>");
  }
  RobotState MeshAt(const std::string& origin, const std::string& file, const std::string& scale) {
    return Visual("<origin xyz='" + origin + "'/><geometry><mesh filename='" + file + "' scale='" +
                  scale + "'/></geometry>");
  }

  static SceneState SceneOf(std::vector<RobotState> robots) {
    SceneState state;
    state.liveness = Liveness::kLive;
    state.robots = std::move(robots);
    state.extent = ExtentOf(state.robots, {});
    return state;
  }

  // From the front, 4 m away, at a height of 1 m.
  static Camera Front() {
    Camera camera;
    camera.position = {4, 0, 1};
    camera.target = {0, 0, 1};
    return camera;
  }

  // What differs from the empty floor.
  Comparison Drawn(const SceneState& state, const Camera& camera) {
    return Compare(renderer_->Render(SceneOf({}), camera, spec_),
                   renderer_->Render(state, camera, spec_));
  }

  void Write(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }

  // The colour where `point` is seen.
  static std::array<int, 3> ColorAt(const Image& image, const Camera& camera,
                                    const Eigen::Vector3d& point) {
    const Projected at = Project(point, camera, kWidth, kHeight);
    const auto index = static_cast<std::size_t>(
        4 * (static_cast<int>(at.y_px) * kWidth + static_cast<int>(at.x_px)));
    return {image.rgba[index], image.rgba[index + 1], image.rgba[index + 2]};
  }

  TempFolder folder_;
  std::vector<std::string> log_;
  std::unique_ptr<Renderer> renderer_;
  PictureSpec spec_;
};

TEST_F(RobotDrawing, ShowsLinksAtThePositionsOfTheirJoints) {
  const std::string xml =
      "<robot name='r'><link name='a'/><link name='b'><visual><geometry><box size='0.2 0.2 0.2'/>"
      "</geometry></visual></link><joint name='j' type='prismatic'><parent link='a'/>"
      "<child link='b'/><origin xyz='0 0 1'/><axis xyz='0 1 0'/>"
      "<limit lower='-1' upper='1' effort='1' velocity='1'/></joint></robot>";
  for (const double position : {-0.5, 0.0, 0.5}) {
    const Comparison drawn = Drawn(SceneOf({Robot(xml, {{"j", position}})}), Front());
    const Projected at = Project({0.1, position, 1}, Front(), kWidth, kHeight);
    EXPECT_NEAR((drawn.left + drawn.right + 1) / 2.0, at.x_px, 3) << position;
    EXPECT_NEAR((drawn.top + drawn.bottom + 1) / 2.0, at.y_px, 3) << position;
    EXPECT_NEAR(drawn.bottom - drawn.top + 1, 0.2 * at.px_per_m, 3) << position;
  }
}

TEST_F(RobotDrawing, ShowsAnyNumberOfLinks) {
  std::string xml = "<robot name='r'><link name='l0'/>";
  for (int i = 1; i <= 100; ++i) {
    const std::string n = std::to_string(i);
    xml += "<link name='l" + n + "'><visual><geometry><box size='0.02 0.02 0.02'/></geometry>" +
           "</visual></link><joint name='j" + n +
           "' type='fixed'><parent link='l0'/><child link='l" + n + "'/><origin xyz='0 " +
           std::to_string((i - 50) * 0.03) + " 1'/></joint>";
  }
  const RobotState robot = Robot(xml + "</robot>");
  const Image picture = renderer_->Render(SceneOf({robot}), Front(), spec_);
  const Image floor = renderer_->Render(SceneOf({}), Front(), spec_);
  for (std::size_t i = 1; i <= 100; ++i) {
    const Eigen::Vector3d front = robot.world_from_link[i] * Eigen::Vector3d(0.01, 0, 0);
    EXPECT_NE(ColorAt(picture, Front(), front), ColorAt(floor, Front(), front)) << i;
  }
}

// A mesh mirrored by its scale is the same surface as one whose corners were mirrored: were it
// inside out, its light or its culled faces would tell.
TEST_F(RobotDrawing, KeepsSurfacesFacingOutwardForNegativeAndUnevenScales) {
  Write("box.stl", BoxStl());
  for (const auto& [scale, origin, size] :
       {std::tuple("-0.2 0.2 0.2", "0.1 -0.2 0.7", "0.2 0.4 0.6"),
        std::tuple("0.2 -0.2 0.2", "-0.1 0.2 0.7", "0.2 0.4 0.6"),
        std::tuple("-0.2 -0.2 -0.2", "0.1 0.2 1.3", "0.2 0.4 0.6"),
        std::tuple("0.4 0.1 -0.3", "-0.2 -0.1 1.45", "0.4 0.2 0.9")}) {
    const RobotState mirrored = MeshAt(origin, "box.stl", scale);
    double x = 0, y = 0, z = 0;
    std::istringstream(size) >> x >> y >> z;
    const RobotState plain = MeshAt(
        std::to_string(-x / 2) + " " + std::to_string(-y / 2) + " " + std::to_string(1 - z / 2),
        "box.stl", std::to_string(x) + " " + std::to_string(y / 2) + " " + std::to_string(z / 3));
    for (const char* name : {"front", "iso", "three_quarter", "left"}) {
      RobotState framed = plain;
      framed.bounds = renderer_->Bounds(plain);
      const Camera camera = NamedCamera(name, SceneOf({framed}));
      const Comparison comparison = Compare(renderer_->Render(SceneOf({plain}), camera, spec_),
                                            renderer_->Render(SceneOf({mirrored}), camera, spec_));
      EXPECT_LT(comparison.pixels, 60) << scale << " from " << name;  // along edges
      EXPECT_GT(Drawn(SceneOf({plain}), camera).pixels, 1000);
    }
  }
}

TEST_F(RobotDrawing, ShowsALabelledBoxForAMissingOrRejectedMeshAndNamesIt) {
  Write("lies.stl", BoxStl(4'000'000'000u));
  Write("giant.stl", BoxStl());
  for (const auto& [file, scale, reason] :
       {std::tuple("package://arm/hand.stl", "1 1 1", "package 'arm' was not found"),
        std::tuple("gone.stl", "1 1 1", "No such file"),
        std::tuple("lies.stl", "1 1 1", "4000000000 triangles"),
        std::tuple("giant.stl", "1000 1000 1000", "millimetres"),
        std::tuple("giant.stl", "0 1 1", "scale is 0")}) {
    const SceneState state = SceneOf({MeshAt("0 0 1", file, scale)});
    log_.clear();
    spec_.overlays = false;
    const Image box = renderer_->Render(state, Front(), spec_);
    ASSERT_EQ(renderer_->problems().size(), 1u) << file;
    EXPECT_THAT(renderer_->problems()[0], HasSubstr(reason));
    EXPECT_EQ(log_, renderer_->problems());
    EXPECT_GT(Drawn(state, Front()).pixels, 200) << file;
    spec_.overlays = true;
    EXPECT_GT(Compare(box, renderer_->Render(state, Front(), spec_)).pixels, 300)
        << "no label over " << file;
    EXPECT_EQ(log_.size(), 1u) << "once, not with every picture";
  }
  spec_.overlays = false;
  renderer_->Render(SceneOf({Visual("<geometry><box size='1 1 1'/></geometry>")}), Front(), spec_);
  EXPECT_THAT(renderer_->problems(), ::testing::IsEmpty());
}

// RViz sorts what shines through by distance; the opaque ones behind it are there before.
TEST_F(RobotDrawing, DrawsTranslucentRobotsOverOpaqueMarkersBehindThem) {
  const RobotState robot = Visual(
      "<origin xyz='0 0 1'/><geometry><box size='0.4 0.4 0.4'/></geometry><material name='m'>"
      "<color rgba='1 0 0 0.5'/></material>");
  auto wall = std::make_shared<SceneMarker>();
  wall->type = MarkerType::kCube;
  wall->pose.position = {-2, 0, 1};
  wall->scale = {0.1, 3, 3};
  wall->color = {0, 0, 1, 1};
  SceneState alone = SceneOf({}), both = SceneOf({robot});
  alone.markers = both.markers = {wall};
  alone.extent = both.extent = ExtentOf({}, {wall});
  const Eigen::Vector3d front(0.2, 0, 1);
  const auto before = ColorAt(renderer_->Render(alone, Front(), spec_), Front(), front);
  const auto after = ColorAt(renderer_->Render(both, Front(), spec_), Front(), front);
  EXPECT_GT(after[0], before[0] + 50) << "half of it is the robot's red";
  EXPECT_GT(after[2], 50) << "and half the blue behind";
}

// As RViz does it.
TEST_F(RobotDrawing, PrefersColoursOfTheFileToThoseOfTheUrdf) {
  Write("box.dae", kinescope::testing::BoxDae());
  Write("plain.obj", kinescope::testing::BoxObj());
  const auto color = [&](const std::string& file, const std::string& material) {
    const RobotState robot = Visual("<origin xyz='-0.5 -1 0'/><geometry><mesh filename='" + file +
                                    "'/></geometry>" + material);
    return ColorAt(renderer_->Render(SceneOf({robot}), Front(), spec_), Front(), {0.5, 0, 1});
  };
  const std::string green = "<material name='m'><color rgba='0.1 0.9 0.1 1'/></material>";
  for (const std::string& material : {std::string(), green}) {
    const auto from_file = color("box.dae", material);
    EXPECT_GT(from_file[0], 2 * from_file[1]) << "red, whatever the URDF says: " << material;
  }
  const auto from_urdf = color("plain.obj", green);
  EXPECT_GT(from_urdf[1], 2 * from_urdf[0]) << "green";
  const auto from_none = color("plain.obj", "");
  EXPECT_NEAR(from_none[0], from_none[1], 12) << "grey";
}

TEST_F(RobotDrawing, IgnoresTheUpAxisOfColladaAsRVizDoes) {
  kinescope::testing::DaeOptions options;
  Write("z.dae", kinescope::testing::BoxDae(options));
  const SceneState as_written = SceneOf({MeshAt("0 0 0.5", "z.dae", "0.2 0.2 0.2")});
  for (const char* up : {"Y_UP", "X_UP"}) {
    options.up = up;
    Write(std::string(up) + ".dae", kinescope::testing::BoxDae(options));
    const SceneState told = SceneOf({MeshAt("0 0 0.5", std::string(up) + ".dae", "0.2 0.2 0.2")});
    EXPECT_TRUE(Compare(renderer_->Render(as_written, Front(), spec_),
                        renderer_->Render(told, Front(), spec_))
                    .equal())
        << up;
  }
}

TEST_F(RobotDrawing, BlendsTranslucentVisualsWithTheirBackground) {
  const std::string back =
      "<visual><origin xyz='-1 0 1'/><geometry><box size='0.1 0.5 0.5'/></geometry>"
      "<material name='r'><color rgba='0.9 0.05 0.05 1'/></material></visual>";
  const auto with_pane = [&](const std::string& alpha) {
    return ColorAt(
        renderer_->Render(
            SceneOf(
                {Robot("<robot name='r'><link name='a'><visual><origin xyz='1 0 1'/><geometry>"
                       "<box size='0.05 1 1'/></geometry><material name='p'><color rgba='0 0 1 " +
                       alpha + "'/></material></visual>" + back + "</link></robot>")}),
            Front(), spec_),
        Front(), {1, 0.05, 1});
  };
  EXPECT_GT(with_pane("1")[2], 5 * with_pane("1")[0]);
  EXPECT_GT(with_pane("0.3")[0], with_pane("0.3")[2]);
  EXPECT_GT(with_pane("0.3")[2], with_pane("0")[2] + 20);
  EXPECT_LT(with_pane("0")[2], 60) << "alpha 0 is not there at all";
}

// As a plan beside the robot that follows it. Colours of a file become translucent, too.
TEST_F(RobotDrawing, BlendsARobotThatIsTranslucentAsAWhole) {
  Write("red.dae", kinescope::testing::BoxDae());
  const RobotState wall = Robot(
      "<robot name='r'><link name='a'><visual><origin xyz='-1 0 1'/><geometry><box "
      "size='0.1 2 2'/></geometry><material name='b'><color rgba='0.05 0.05 0.9 1'/></material>"
      "</visual></link></robot>");
  const auto seen = [&](double opacity) {
    RobotState box =
        Visual("<origin xyz='-0.5 -1 0'/><geometry><mesh filename='red.dae'/></geometry>");
    box.model = std::make_shared<const urdf::RobotModel>(urdf::Translucent(*box.model, opacity));
    return ColorAt(renderer_->Render(SceneOf({wall, box}), Front(), spec_), Front(), {0.5, 0, 1});
  };
  const auto solid = seen(1), half = seen(0.5), none = seen(0);
  EXPECT_GT(solid[0], 2 * solid[2]);
  EXPECT_GT(none[2], 2 * none[0]) << "what is behind it";
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(half[k], (solid[k] + none[k]) / 2, 40) << k;
  }
}

TEST_F(RobotDrawing, OmitsLinksWithNonFinitePoses) {
  RobotState robot = Visual("<geometry><box size='1 1 1'/></geometry>");
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300}) {
    robot.world_from_link[0].translation() = Eigen::Vector3d(bad, 0, 0);
    EXPECT_TRUE(Drawn(SceneOf({robot}), Front()).equal());
    EXPECT_TRUE(renderer_->Bounds(robot).isEmpty());
  }
  robot.world_from_link.clear();
  EXPECT_TRUE(Drawn(SceneOf({robot}), Front()).equal());
}

TEST_F(RobotDrawing, ComputesTheBoundsOfTheVisuals) {
  Write("box.stl", BoxStl());
  RobotState robot = MeshAt("0 0 0", "box.stl", "1 1 1");
  robot.world_from_link[0] =
      Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(M_PI / 4, Eigen::Vector3d::UnitZ());
  const Eigen::AlignedBox3d box = renderer_->Bounds(robot);
  const double half = std::sqrt(0.5);
  EXPECT_LT((box.min() - Eigen::Vector3d(1 - 2 * half, 2, 3)).norm(), 1e-6);
  EXPECT_LT((box.max() - Eigen::Vector3d(1 + half, 2 + 3 * half, 6)).norm(), 1e-6);
  EXPECT_TRUE(renderer_->Bounds(Robot("<robot name='r'><link name='a'/></robot>")).isEmpty());
}

TEST_F(RobotDrawing, FitsARobotOfAnySizeIntoNamedViews) {
  for (const double size : {0.05, 1.0, 40.0}) {
    const std::string text = std::to_string(size);
    RobotState robot =
        Visual("<origin xyz='3 0 " + std::to_string(size / 2) + "'/><geometry><box size='" + text +
               " " + text + " " + text + "'/></geometry>");
    robot.bounds = renderer_->Bounds(robot);
    for (const std::string& name : CameraNames()) {
      const SceneState state = SceneOf({robot});
      const Camera camera = NamedCamera(name, state);
      for (int corner = 0; corner < 8; ++corner) {
        const Projected at =
            Project(robot.bounds.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)),
                    camera, kWidth, kHeight);
        EXPECT_GT(at.depth_m, camera.near_m) << name << " " << size;
        EXPECT_LT(at.depth_m, camera.far_m) << name << " " << size;
        EXPECT_GT(at.y_px, 0) << name << " " << size;
        EXPECT_LT(at.y_px, kHeight) << name << " " << size;
      }
      const Comparison drawn = Drawn(state, camera);
      EXPECT_GT(drawn.bottom - drawn.top, kHeight / 3) << name << " " << size;
    }
  }
}

TEST_F(RobotDrawing, ShowsARobotBesideAPersonUntilItIsRemoved) {
  const SceneState alone = kinescope::testing::SceneWith(kinescope::testing::Posture::kStanding);
  SceneState both = alone;
  both.robots.push_back(Visual("<origin xyz='0 1 0.5'/><geometry><box size='1 1 1'/></geometry>"));
  const Camera camera = NamedCamera("front", alone);
  const Image before = renderer_->Render(alone, camera, spec_);
  EXPECT_GT(Compare(before, renderer_->Render(both, camera, spec_)).pixels, 1000);
  EXPECT_TRUE(Compare(before, renderer_->Render(alone, camera, spec_)).equal());
}

TEST_F(RobotDrawing, ShowsTheSamePictureAtAnotherFloorHeight) {
  SceneState state =
      SceneOf({Visual("<origin xyz='0 0 0.5'/><geometry><box size='1 1 1'/></geometry>")});
  Camera camera = Front();
  const Image ground = renderer_->Render(state, camera, spec_);
  const Eigen::Vector3d up(0, 0, 3);
  state.floor_z = up.z();
  state.robots[0].world_from_link[0].pretranslate(up);
  camera.position += up;
  camera.target += up;
  EXPECT_TRUE(Compare(ground, renderer_->Render(state, camera, spec_)).equal());
}

// The template with a box for every link, each put in place by the mesh of its name.
TEST_F(RobotDrawing, RendersThePublishedHumanModelsOfOtherProjects) {
  KINESCOPE_NEEDS_SHARED_DATA("models/human-model-generator/humanModelTemplate.urdf");
  using kinescope::testing::ReadFile;
  using kinescope::testing::SharedData;
  const auto draw = [&](const std::string& xml, const std::string& folder) {
    RobotState robot = Robot(xml);
    robot.meshes = std::make_shared<urdf::MeshSearch>(
        urdf::MakeMeshSearch(SharedData("models/" + folder + "/r.urdf"), {}));
    robot.bounds = renderer_->Bounds(robot);
    const SceneState state = SceneOf({robot});
    const Comparison drawn = Drawn(state, NamedCamera("three_quarter", state));
    EXPECT_GT(drawn.bottom - drawn.top, kHeight / 2) << folder;
    EXPECT_THAT(renderer_->problems(), ::testing::IsEmpty());
    return robot.bounds;
  };
  const Eigen::AlignedBox3d gazebo =
      draw(ReadFile(SharedData("models/human-gazebo/humanSubject01_66dof.urdf")), "human-gazebo");
  EXPECT_GT(gazebo.sizes().z(), 1.4);
  EXPECT_LT(gazebo.sizes().z(), 1.9);

  std::string xml = ReadFile(SharedData("models/human-model-generator/humanModelTemplate.urdf"));
  std::string out;
  int meshes = 0;
  const std::regex link("<link name=\"(\\w+)\">");
  std::string name;
  std::istringstream lines(xml);
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (std::regex_search(line, match, link)) name = match[1];
    const std::string mesh = "meshes/" + name + ".stl";
    const bool has_mesh =
        std::filesystem::exists(SharedData("models/human-model-generator/" + mesh));
    if (has_mesh && line.find("<box") != std::string::npos) {
      line = "<mesh filename=\"" + mesh + "\"/>";
      ++meshes;
    }
    out += line + "\n";
  }
  EXPECT_GE(meshes, 23);
  draw(out, "human-model-generator");
}

}  // namespace
}  // namespace kinescope::render
