// What is beside the people, as the file that the page reads.
#include "render/surroundings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "tests/render/marker_samples.h"
#include "tests/temp_folder.h"
#include "tests/urdf/mesh_samples.h"
#include "urdf/rig/glb_container.h"
#include "urdf/rig/glb_values.h"
#include "urdf/robot/robot_kinematics.h"

namespace kinescope::render {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Markers = std::vector<std::shared_ptr<const SceneMarker>>;

// A file, taken apart.
class Glb {
 public:
  explicit Glb(std::string bytes)
      : bytes_(std::move(bytes)),
        chunks_(urdf::SplitGlb(bytes_)),
        document_(urdf::ParseGlbJson(chunks_.json)) {}

  const json& document() const { return document_; }
  json problems() const { return document_["scenes"][0]["extras"]["problems"]; }
  json Node(const std::string& name) const {
    for (const json& node : document_["nodes"]) {
      if (node["name"] == name) return node;
    }
    return nullptr;
  }
  json Primitives(const std::string& node) const {
    return document_["meshes"][Node(node)["mesh"].get<std::size_t>()]["primitives"];
  }
  // Of the corners of all triangles of a primitive.
  Eigen::AlignedBox3d BoxOf(const json& primitive) const {
    const rig::Accessor at(document_, chunks_.binary, primitive["attributes"]["POSITION"], "VEC3");
    const rig::Accessor corners(document_, chunks_.binary, primitive["indices"], "SCALAR");
    Eigen::AlignedBox3d box;
    for (std::size_t i = 0; i < corners.count(); ++i) {
      const auto vertex = static_cast<std::size_t>(corners.Whole(i));
      box.extend(Eigen::Vector3d(at.Number(vertex, 0), at.Number(vertex, 1), at.Number(vertex, 2)));
    }
    return box;
  }
  std::vector<double> ColorOf(const json& primitive) const {
    const rig::Accessor colors(document_, chunks_.binary, primitive["attributes"]["COLOR_0"],
                               "VEC4");
    std::vector<double> color;
    for (std::size_t i = 0; i < 4; ++i) color.push_back(colors.Number(0, i, true));
    return color;
  }

 private:
  const std::string bytes_;
  const urdf::GlbChunks chunks_;
  const json document_;
};

Markers Shared(std::vector<SceneMarker> markers) {
  Markers shared;
  for (SceneMarker& marker : markers) {
    shared.push_back(std::make_shared<const SceneMarker>(std::move(marker)));
  }
  return shared;
}

SceneMarker Cube(double opacity = 1) {
  SceneMarker cube;
  cube.ns = "walls";
  cube.pose.position = {1, 2, 3};
  cube.scale = {0.2, 0.4, 0.6};
  cube.color = {1, 0.5, 0, opacity};
  return cube;
}

void ExpectBox(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& low,
               const Eigen::Vector3d& high) {
  EXPECT_LT((box.min() - low).norm(), 1e-5) << box.min().transpose();
  EXPECT_LT((box.max() - high).norm(), 1e-5) << box.max().transpose();
}

TEST(Surroundings, HaveMarkersWithTheirPlacesAndColors) {
  const auto writer = MakeSurroundingsWriter();
  const Glb glb(writer->Write(Shared({Cube(), Cube(0.5)}), {}));
  const json parts = glb.Primitives("markers");
  ASSERT_EQ(parts.size(), 2u) << "opaque, translucent";
  for (const json& part : parts) ExpectBox(glb.BoxOf(part), {0.9, 1.8, 2.7}, {1.1, 2.2, 3.3});
  const json& materials = glb.document()["materials"];
  EXPECT_FALSE(materials[parts[0]["material"].get<std::size_t>()].contains("alphaMode"));
  EXPECT_EQ(materials[parts[1]["material"].get<std::size_t>()]["alphaMode"], "BLEND");
  // sRGB 0.5 is 0.214 in linear light.
  const std::vector<double> color = glb.ColorOf(parts[1]);
  const double expected[] = {1, 0.2140, 0, 0.5};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(color[i], expected[i], 1e-3) << i;
  EXPECT_TRUE(glb.problems().empty());
}

TEST(Surroundings, HaveMapsUnlitAndByTheirNameBeforeAllElse) {
  SceneMarker map;
  map.type = MarkerType::kTriangleList;
  map.ground = GroundLayer::kMap;
  map.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  const Glb glb(MakeSurroundingsWriter()->Write(Shared({Cube(), map}), {}));
  const json parts = glb.Primitives("markers");
  ASSERT_EQ(parts.size(), 3u);
  for (const std::size_t i : {0u, 1u}) {
    ExpectBox(glb.BoxOf(parts[i]), {0, 0, 0}, {1, 1, 0});
    const json& material = glb.document()["materials"][parts[i]["material"].get<std::size_t>()];
    EXPECT_EQ(material["name"], i == 0 ? "ground depth" : "ground");
    EXPECT_TRUE(material["extensions"].contains("KHR_materials_unlit"));
  }
  map.color.w() = 0.7;
  const Glb clear(MakeSurroundingsWriter()->Write(Shared({map}), {}));
  EXPECT_EQ(clear.Primitives("markers").size(), 1u) << "it hides nothing";
  EXPECT_EQ(glb.document()["extensionsUsed"], json{"KHR_materials_unlit"});
}

// x left, y up, z forward: what viewers of such files expect.
TEST(Surroundings, StandUprightInOtherViewers) {
  const Glb glb(MakeSurroundingsWriter()->Write(Shared({Cube()}), {}));
  const json& root = glb.document()["nodes"][0];
  EXPECT_EQ(root["children"].size(), 1u);
  const auto q = root["rotation"].get<std::vector<double>>();
  const Eigen::Quaterniond turn(q[3], q[0], q[1], q[2]);
  EXPECT_LT((turn * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitY()).norm(), 1e-9);
  EXPECT_LT((turn * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitZ()).norm(), 1e-9);
}

TEST(Surroundings, HaveEveryTypeOfMarker) {
  const kinescope::testing::TempFolder folder;
  std::ofstream(folder / "box.stl", std::ios::binary) << kinescope::testing::BoxStl();
  const auto writer = MakeSurroundingsWriter();
  std::vector<SceneMarker> all =
      kinescope::testing::MarkersOfAllTypes("file://" + (folder / "box.stl").string());
  ASSERT_EQ(all.size(), 12u);
  for (const SceneMarker& marker : all) {
    const Glb glb(writer->Write(Shared({marker}), {}));
    EXPECT_TRUE(glb.problems().empty()) << Name(marker.type) << glb.problems();
    if (marker.type == MarkerType::kText) {
      const json label = glb.Node("label");
      EXPECT_EQ(label["extras"]["text"], marker.text);
      EXPECT_NEAR(label["extras"]["height"].get<double>(), 0.62 * marker.scale.z(), 1e-6);
      EXPECT_EQ(label["translation"][2], marker.pose.position.z());
      continue;
    }
    if (marker.type == MarkerType::kPoints) {
      const json part = glb.Primitives("points")[0];
      EXPECT_EQ(part["mode"], 0) << "points";
      EXPECT_EQ(
          glb.document()["accessors"][part["attributes"]["POSITION"].get<std::size_t>()]["count"],
          marker.points.size());
      EXPECT_NEAR(glb.Node("points")["extras"]["size"][0].get<double>(), marker.scale.x(), 1e-6);
      EXPECT_EQ(glb.Node("points")["extras"]["in_pixels"], false);
      EXPECT_FALSE(part["attributes"].contains("NORMAL")) << "other viewers light them then";
      continue;
    }
    const Eigen::AlignedBox3d box = glb.BoxOf(glb.Primitives("markers")[0]);
    EXPECT_LT(box.exteriorDistance(marker.pose.position), 1e-4) << Name(marker.type);
    EXPECT_LT(box.sizes().maxCoeff(), 1) << Name(marker.type);
  }
}

TEST(Surroundings, HaveThinLinesAsLines) {
  SceneMarker grid;
  grid.type = MarkerType::kLineList;
  grid.is_in_pixels = true;
  grid.color = {1, 0, 0, 0.5};
  grid.points = {{1, 2, 3}, {1, 2, 4}, {0, 0, 0}, {1, 1, 1}};
  const Glb glb(MakeSurroundingsWriter()->Write(Shared({grid}), {}));
  const json part = glb.Primitives("lines")[0];
  EXPECT_EQ(part["mode"], 1) << "lines";
  EXPECT_EQ(glb.document()["accessors"][part["attributes"]["POSITION"].get<std::size_t>()]["count"],
            4);
  EXPECT_EQ(glb.document()["materials"][part["material"].get<std::size_t>()]["alphaMode"], "BLEND");
}

TEST(Surroundings, HaveSizesOfPointsInPixels) {
  SceneMarker points;
  points.type = MarkerType::kPoints;
  points.scale = {3, 4, 0};
  points.is_in_pixels = true;
  points.points = {{1, 2, 3}};
  const Glb glb(MakeSurroundingsWriter()->Write(Shared({points}), {}));
  EXPECT_EQ(glb.Node("points")["extras"], json::parse(R"({"size": [3, 4], "in_pixels": true})"));
}

TEST(Surroundings, AreEmptyWithoutAny) {
  const Glb glb(MakeSurroundingsWriter()->Write({}, {}));
  EXPECT_EQ(glb.document()["nodes"].size(), 1u);
  EXPECT_FALSE(glb.document().contains("buffers"));
}

TEST(Surroundings, NameWhatIsNotShown) {
  SceneMarker flood = Cube(), bad = Cube(), missing = Cube(), text = Cube();
  flood.type = MarkerType::kSphereList;
  flood.points.assign(kMaxMarkerPoints, Eigen::Vector3d::Zero());
  bad.pose.position.x() = std::numeric_limits<double>::quiet_NaN();
  missing.type = MarkerType::kMesh;
  missing.mesh_uri = "file:///nowhere/door.stl";
  text.type = MarkerType::kText;
  text.text = "not \xFF UTF-8";
  const Glb glb(MakeSurroundingsWriter()->Write(Shared({flood, bad, missing, text, Cube()}), {}));
  EXPECT_THAT(glb.problems().get<std::vector<std::string>>(),
              ElementsAre(HasSubstr("too many triangles"), HasSubstr("not finite"),
                          HasSubstr("/nowhere/door.stl")));
  ASSERT_EQ(glb.Primitives("markers").size(), 1u) << "the box of the missing mesh, and the cube";
  EXPECT_EQ(glb.Node("label")["extras"]["text"], "missing: door.stl");
  EXPECT_EQ(glb.document()["nodes"].back()["extras"]["text"], "not \xEF\xBF\xBD UTF-8");
}

RobotState Robot() {
  RobotState robot;
  robot.model = std::make_shared<urdf::RobotModel>(urdf::ParseUrdf(
      "<robot name='arm'><link name='base'><visual><geometry><box size='0.2 0.2 0.2'/></geometry>"
      "</visual></link><link name='hand'><visual><geometry><box size='0.1 0.1 0.1'/></geometry>"
      "</visual></link><joint name='j' type='fixed'><parent link='base'/><child link='hand'/>"
      "<origin xyz='0 0 1'/></joint></robot>"));
  robot.name = "arm";
  robot.world_from_link = urdf::PlaceLinks(*robot.model, {});
  return robot;
}

TEST(Surroundings, HaveRobotsWhereTheirLinksAre) {
  const auto writer = MakeSurroundingsWriter();
  RobotState robot = Robot();
  const auto box_of = [&] {
    const Glb glb(writer->Write({}, {robot}));
    return glb.BoxOf(glb.Primitives("robot arm")[0]);
  };
  ExpectBox(box_of(), {-0.1, -0.1, -0.1}, {0.1, 0.1, 1.05});
  for (Eigen::Isometry3d& link : robot.world_from_link) {
    link.pretranslate(Eigen::Vector3d(0, 2, 0));
  }
  ExpectBox(box_of(), {-0.1, 1.9, -0.1}, {0.1, 2.1, 1.05});
  robot.world_from_link[1].translation().x() = std::numeric_limits<double>::quiet_NaN();
  ExpectBox(box_of(), {-0.1, 1.9, -0.1}, {0.1, 2.1, 0.1});
  robot.world_from_link.clear();
  EXPECT_TRUE(Glb(writer->Write({}, {robot})).Node("robot arm").is_null()) << "it is nowhere";
}

TEST(Surroundings, HaveTheLinksOfRobotsThatMoveInTheirOwnFrames) {
  const auto writer = MakeSurroundingsWriter();
  RobotState standing = Robot(), moving = Robot();
  moving.moves = true;
  moving.problem = "robot 'arm': 1 of 2 links have no place in TF: hand";
  for (Eigen::Isometry3d& link : moving.world_from_link) {
    link.pretranslate(Eigen::Vector3d(0, 2, 0));
  }
  const Glb glb(writer->Write({}, {standing, moving, moving}));
  const nlohmann::json& nodes = glb.document()["nodes"];
  ASSERT_EQ(nodes.size(), 8u) << "the root, one that stands, two with two links each";
  ExpectBox(glb.BoxOf(glb.Primitives("robot arm")[0]), {-0.1, -0.1, -0.1}, {0.1, 0.1, 1.05});
  EXPECT_EQ(nodes[0]["children"], nlohmann::json({1, 2, 5}));
  EXPECT_EQ(nodes[2]["extras"]["robot"], 0);
  EXPECT_EQ(nodes[5]["extras"]["robot"], 1);
  EXPECT_EQ(nodes[2]["children"], nlohmann::json({3, 4}));
  EXPECT_EQ(nodes[4]["extras"]["link"], 1);
  const nlohmann::json& mesh = glb.document()["meshes"][nodes[4]["mesh"].get<std::size_t>()];
  ExpectBox(glb.BoxOf(mesh["primitives"][0]), {-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05});
  EXPECT_THAT(glb.problems().get<std::vector<std::string>>(),
              ElementsAre(moving.problem, moving.problem));
}

}  // namespace
}  // namespace kinescope::render
