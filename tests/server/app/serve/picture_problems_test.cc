// What the server's pictures cannot show is named in its status: a real server, asked over its
// port.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "server/app/serve/diagnostics.h"
#include "server/app/serve/live_pictures.h"
#include "server/http/server.h"
#include "tests/folders.h"
#include "tests/server/http/test_client.h"
#include "urdf/robot/robot_kinematics.h"

namespace kinescope::app {
namespace {

using http::testing::Fetch;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

SceneState Scene() {
  SceneState scene;
  scene.liveness = Liveness::kLive;
  scene.number = 1;
  return scene;
}

// A robot of one link whose mesh is nowhere.
RobotState Robot(const std::string& mesh) {
  RobotState robot;
  robot.name = "arm";
  robot.model = std::make_shared<urdf::RobotModel>(
      urdf::ParseUrdf("<robot name='arm'><link name='hand'><visual><geometry><mesh filename='" +
                      mesh + "'/></geometry></visual></link></robot>"));
  robot.world_from_link = urdf::PlaceLinks(*robot.model, {});
  return robot;
}

class PictureProblems : public ::testing::Test {
 protected:
  PictureProblems()
      : first_(std::make_shared<const SceneState>(Scene())),
        drawing_({CameraController(ParseCamera("front"), {}), {}, 64, 64, 30}, RenderersOf({}),
                 first_, pictures_),
        server_(Config(), states_, pictures_, &drawing_,
                [this] { return DiagnosticsJson(first_, nullptr, {}, drawing_.status()); }) {}

  static http::HttpConfig Config() {
    http::HttpConfig config;
    config.port = 0;
    config.web_root = kinescope::testing::InSourceTree("web");
    config.cameras = {{"front"}};
    config.camera = "front";
    return config;
  }

  // After a picture of `scene`.
  nlohmann::json ProblemsWith(const SceneState& scene) {
    drawing_.OnState(std::make_shared<const SceneState>(scene));
    EXPECT_EQ(Fetch(server_.port(), "/api/v1/snapshot.png?width=64&height=64").status, 200);
    return Fetch(server_.port(), "/api/v1/diagnostics").json().at("pictures").at("problems");
  }

  Latest<SceneState> states_;
  Latest<http::Picture> pictures_;
  std::shared_ptr<const SceneState> first_;
  LivePictures drawing_;
  http::HttpServer server_;
};

TEST_F(PictureProblems, NameAMissingMeshOfARobotWhileTheRobotIsShown) {
  EXPECT_EQ(ProblemsWith(Scene()), nlohmann::json::array());
  SceneState with_robot = Scene();
  with_robot.robots.push_back(Robot("package://arm_description/meshes/hand.stl"));
  const auto problems = ProblemsWith(with_robot).get<std::vector<std::string>>();
  EXPECT_THAT(problems, ElementsAre(AllOf(HasSubstr("package://arm_description/meshes/hand.stl"),
                                          HasSubstr("'arm_description' was not found"))));
  EXPECT_EQ(ProblemsWith(Scene()), nlohmann::json::array()) << "the robot has left";
}

TEST_F(PictureProblems, AreValidTextForFileNamesWithInvalidUtf8) {
  SceneState with_robot = Scene();
  with_robot.robots.push_back(Robot("/nowhere/h.stl"));
  auto model = std::make_shared<urdf::RobotModel>(*with_robot.robots[0].model);
  model->links[0].visuals[0].geometry.mesh_uri = "/nowhere/\xFF\xFE.stl";
  with_robot.robots[0].model = model;
  EXPECT_EQ(ProblemsWith(with_robot).size(), 1u);
}

}  // namespace
}  // namespace kinescope::app
