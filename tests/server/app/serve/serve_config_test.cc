#include "server/app/serve/serve_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "core/system/errors.h"
#include "tests/server/options_testing.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

ServeConfig ConfigOf(const testing::Settings& settings, bool with_page = true) {
  return MakeServeConfig(testing::With<ServeOptions>(settings), with_page);
}

std::string ErrorOf(const testing::Settings& settings, bool with_page = true) {
  try {
    ConfigOf(settings, with_page);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(ServeConfig, HasEveryPartByDefault) {
  const ServeConfig config = ConfigOf({});
  EXPECT_EQ(config.source_url, "udp://:9763");
  ASSERT_TRUE(config.page);
  EXPECT_EQ(config.page->camera, "three_quarter");
  EXPECT_EQ(config.page->cameras.size(), render::CameraNames().size());
  ASSERT_TRUE(config.pictures);
  EXPECT_EQ(config.pictures->camera.name(), "three_quarter");
  EXPECT_EQ(config.ros.has_value(), ros_bridge::BuiltWithRos());
  EXPECT_EQ(config.ros_camera.has_value(), ros_bridge::BuiltWithRos());
  EXPECT_THAT(config.notes, IsEmpty());
}

TEST(ServeConfig, HasNeitherPageNorPicturesForABridge) {
  const ServeConfig config = ConfigOf({{"ros", "required"}}, false);
  EXPECT_FALSE(config.page);
  EXPECT_FALSE(config.pictures);
  EXPECT_FALSE(config.ros_camera);
  ASSERT_TRUE(config.ros) << "without ROS in this build, the bridge reports that";
  EXPECT_FALSE(config.ros->with_view);
  EXPECT_TRUE(config.ros->shown.is_empty());
}

TEST(ServeConfig, TakesTheTopicsOfABagWithoutRos) {
  const kinescope::testing::TempFolder folder;
  const std::string bag = folder / "lab.bag";
  std::ofstream(bag) << "#ROSBAG V2.0\n";
  ServeOptions options;
  options::OptionList list;
  options.List(list);
  const auto set = [&](const std::string& name, const std::string& text) {
    list.Set(*list.Find(name), name, {text, ""}, options::Channel::kCommandLine);
  };
  set("ros", "off");
  set("marker_topics", "/cloud");
  EXPECT_FALSE(list.HasEffect("marker_topics"));
  set("source", bag);
  EXPECT_TRUE(list.HasEffect("marker_topics"));
  set("camera_tf", "cart");
  EXPECT_FALSE(list.HasEffect("camera_tf")) << "named cameras are of the people";
  set("camera", "0,-4,1:0,0,1");
  EXPECT_TRUE(list.HasEffect("camera_tf"));
}

TEST(ServeConfig, UdpPortReplacesTheSource) {
  EXPECT_EQ(ConfigOf({{"source", "demo:lift"}}).source_url, "demo:lift");
  EXPECT_EQ(ConfigOf({{"source", "demo:lift"}, {"udp_port", "9000"}}).source_url, "udp://:9000");
}

TEST(ServeConfig, StopsOnlyInARecordingAndPublishesNothingThen) {
  const ServeConfig config = ConfigOf({{"source", "demo:lift"}, {"stop_at", "2.5"}});
  EXPECT_EQ(config.stop_at, 2'500'000'000);
  EXPECT_FALSE(config.ros);
  EXPECT_FALSE(config.scene.makes_models_aside) << "its states are then the same in each run";
  EXPECT_EQ(ConfigOf({{"source", "demo:lift"}}).stop_at, std::nullopt);
  EXPECT_EQ(ConfigOf({{"source", "demo:lift"}}).start_at, 0);
  EXPECT_EQ(ConfigOf({{"source", "demo:lift"}, {"start_at", "2.5"}}).start_at, 2'500'000'000);
  EXPECT_THAT(ErrorOf({{"source", "ros:"}, {"start_at", "2.5"}}),
              HasSubstr("--start_at=2.5: a live source has no such moment"));
  for (const char* live : {"udp://:9763", "tcp://:9763", "ros:"}) {
    EXPECT_THAT(ErrorOf({{"source", live}, {"stop_at", "2.5"}}),
                HasSubstr("--stop_at=2.5: a live source has no such moment; expected demo:MOTION"));
  }
  EXPECT_THAT(ErrorOf({{"udp_port", "9000"}, {"source", "demo:lift"}, {"stop_at", "2.5"}}),
              HasSubstr("a live source"));
}

TEST(ServeConfig, HasNoRosCameraWithoutRos) {
  const ServeConfig config = ConfigOf({{"ros", "off"}, {"pictures", "off"}});
  EXPECT_FALSE(config.ros);
  EXPECT_FALSE(config.ros_camera);
  EXPECT_THAT(config.notes, IsEmpty()) << "nobody expects a topic";
}

TEST(ServeConfig, ReportsThatThereIsNoRosCameraWithoutPictures) {
  const ServeConfig config = ConfigOf({{"ros", "required"}, {"pictures", "off"}});
  EXPECT_FALSE(config.pictures);
  EXPECT_FALSE(config.ros_camera);
  EXPECT_FALSE(config.ros->with_view);
  EXPECT_THAT(config.notes, ElementsAre("~view/image_raw is off because --pictures is off"));
  EXPECT_THAT(ConfigOf({{"ros", "required"}, {"pictures", "off"}, {"view", "off"}}).notes,
              IsEmpty());
}

TEST(ServeConfig, UsesTheCameraOfThePageForRosByDefault) {
  const ServeConfig same = ConfigOf({{"ros", "required"}, {"camera", "top"}});
  ASSERT_TRUE(same.ros_camera);
  EXPECT_EQ(same.ros_camera->camera.name(), "top");
  const ServeConfig own =
      ConfigOf({{"ros", "required"}, {"camera", "top"}, {"view_camera", "left"}});
  EXPECT_EQ(own.ros_camera->camera.name(), "left");
  EXPECT_EQ(own.pictures->camera.name(), "top");
}

TEST(ServeConfig, AppliesNoOptionsOfTheLivePictureToTheRosCamera) {
  const ServeConfig config = ConfigOf({{"ros", "required"},
                                       {"camera", "front"},
                                       {"projection", "orthographic"},
                                       {"fov", "80"},
                                       {"fit", "now"}});
  const SceneState nobody;
  EXPECT_TRUE(config.pictures->camera.Only(nobody, 0, 1).is_orthographic());
  const render::Camera camera = config.ros_camera->camera.Only(nobody, 0, 16.0 / 9);
  EXPECT_FALSE(camera.is_orthographic());
  EXPECT_EQ(camera.vertical_fov_rad, render::NamedCamera("front", nobody).vertical_fov_rad);
}

TEST(ServeConfig, GivesTheRosCameraTheFieldOfViewOfACameraThatWasPlaced) {
  const ServeConfig config =
      ConfigOf({{"ros", "required"}, {"camera", "0,-4,1:0,0,1"}, {"fov", "80"}});
  EXPECT_NEAR(config.ros_camera->camera.Only(SceneState(), 0, 1).vertical_fov_rad, 80 * M_PI / 180,
              1e-9);
}

TEST(ServeConfig, TurnsThePageAndItsPicturesWithThePersonAndTheRosCameraNever) {
  EXPECT_EQ(ConfigOf({}).scene.view_frame, CameraFrame::kStart);
  const ServeConfig config = ConfigOf({{"ros", "required"}, {"camera_frame", "person"}});
  EXPECT_EQ(config.scene.view_frame, CameraFrame::kPerson);
  SceneState turned;
  turned.view_heading = 1;
  const auto moves = [&](const CameraController& camera) {
    const Eigen::Vector3d before = camera.OnlyLive(SceneState(), render::ViewShape{1, {}}).position;
    return (camera.OnlyLive(turned, render::ViewShape{1, {}}).position - before).norm();
  };
  EXPECT_GT(moves(config.pictures->camera), 1);
  EXPECT_EQ(moves(config.ros_camera->camera), 0);
}

TEST(ServeConfig, DrawsPeopleAlikeInAllPicturesAndOnThePage) {
  const ServeConfig plain = ConfigOf({});
  EXPECT_EQ(plain.pictures->people.style, render::Style::kMatte);
  EXPECT_EQ(plain.page->look.loads, "spheres");
  const ServeConfig config = ConfigOf(
      {{"ros", "required"}, {"loads", "both"}, {"style", "clay"}, {"body_opacity", "0.5"}});
  EXPECT_EQ(config.pictures->people.loads, render::LoadsShown::kBoth);
  EXPECT_EQ(config.pictures->people.style, render::Style::kClay);
  EXPECT_EQ(config.ros_camera->people.loads, render::LoadsShown::kBoth);
  EXPECT_EQ(config.ros_camera->people.style, render::Style::kClay);
  EXPECT_EQ(config.page->look.loads, "both");
  EXPECT_EQ(config.page->look.style, "clay");
  EXPECT_EQ(config.page->look.body_opacity, 0.5);
  EXPECT_EQ(config.pictures->people.body_opacity, 0.5);
  EXPECT_EQ(*config.clips->view.body_opacity, 0.5);
  EXPECT_TRUE(config.page->look.draws_skins);
  EXPECT_FALSE(ConfigOf({{"figure", "urdf"}}).page->look.draws_skins);
}

TEST(ServeConfig, HasABackgroundInAllPicturesOfTheServer) {
  EXPECT_FALSE(ConfigOf({{"ros", "required"}}).pictures->background);
  const ServeConfig config = ConfigOf({{"ros", "required"}, {"background", "#302020"}});
  const Rgb dark = *ColorFromHex("#302020");
  EXPECT_EQ(config.pictures->background, dark);
  EXPECT_EQ(config.ros_camera->background, dark);
  EXPECT_EQ(config.clips->view.background->color, dark);
  EXPECT_EQ(*config.clips->view.theme, render::Theme::kDark);
  EXPECT_THROW((void)ConfigOf({{"background", "transparent"}}), UsageError);
}

TEST(ServeConfig, TellsThePageOfACameraThatWasPlaced) {
  EXPECT_EQ(ConfigOf({{"camera", "front"}}).page->camera, "front");
  EXPECT_EQ(ConfigOf({}).page->cameras.size(), render::CameraNames().size());
  const ServeConfig config = ConfigOf({{"ros", "required"},
                                       {"camera", "3,0,2:0,0,1:0,1,0"},
                                       {"camera_tf", "cart:heading"},
                                       {"fov", "60"}});
  EXPECT_EQ(config.page->camera, http::kOwnCamera);
  const http::CameraView& own = config.page->cameras.back();
  EXPECT_EQ(own.name, http::kOwnCamera);
  EXPECT_EQ(own.position, Eigen::Vector3d(3, 0, 2));
  EXPECT_EQ(own.target, Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(own.up, Eigen::Vector3d(0, 1, 0));
  EXPECT_NEAR(own.vertical_fov_rad, M_PI / 3, 1e-12);
  EXPECT_EQ(own.turn, "heading");
  EXPECT_EQ(config.clips->own_camera, "3,0,2:0,0,1:0,1,0");
}

TEST(ServeConfig, DoesNotRepublishFramesOfARosGraph) {
  const testing::Settings graph = {{"source", "ros:"}, {"ros", "required"}};
  const ServeConfig config = ConfigOf(graph);
  EXPECT_EQ(config.ros->tf, "none");
  EXPECT_THAT(config.notes, ElementsAre(HasSubstr("not republished")));
  EXPECT_EQ(ConfigOf({{"source", "demo:lift"}, {"ros", "required"}}).ros->tf, "flat");
}

TEST(ServeConfig, NamesLinksAfterTheFramesOfARosGraph) {
  const auto takes_names = [](const char* source, const char* model = "skeleton") {
    return ConfigOf({{"source", source}, {"ros", "required"}, {"model_name", model}})
        .scene.takes_names;
  };
  EXPECT_TRUE(takes_names("ros:"));
  EXPECT_TRUE(takes_names("ros:/lab/tf"));
  EXPECT_FALSE(takes_names("ros:", "anna"));
  EXPECT_FALSE(takes_names("ros:/xsens/link_states")) << "that is the name of a node";
  EXPECT_FALSE(takes_names("demo:lift"));
}

TEST(ServeConfig, ChecksOptionsOfPartsThatAreOff) {
  const testing::Settings off = {{"ros", "off"}, {"pictures", "off"}, {"view", "off"}};
  const auto error_with = [&](const std::string& name, const std::string& text) {
    testing::Settings settings = off;
    settings.emplace_back(name, text);
    return ErrorOf(settings);
  };
  EXPECT_EQ(ErrorOf(off), "");
  EXPECT_THAT(error_with("camera", "/nowhere/keys.yaml"), HasSubstr("/nowhere/keys.yaml"));
  EXPECT_THAT(error_with("view_camera", "/nowhere/keys.yaml"), HasSubstr("/nowhere/keys.yaml"));
  EXPECT_THAT(error_with("orbit", "turn"), HasSubstr("--orbit=turn"));
  EXPECT_THAT(error_with("fit", "clip"), HasSubstr("--fit=clip"));
}

}  // namespace
}  // namespace kinescope::app
