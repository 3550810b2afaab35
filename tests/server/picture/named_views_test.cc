// The same name is the same view in picture, page and RViz.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "render/camera/camera.h"
#include "tests/folders.h"
#include "tests/render/test_scene.h"

namespace kinescope::app {
namespace {

using Eigen::Vector3d;
using testing::InSourceTree;

Vector3d ToVector(const nlohmann::json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

TEST(NamedViews, MatchTheViewsThatThePageTestsUse) {
  std::ifstream file(InSourceTree("tests/browser/unit/named_views.json"));
  ASSERT_TRUE(file);
  const nlohmann::json page = nlohmann::json::parse(file);
  const nlohmann::json& framing = page.at("framing");
  EXPECT_EQ(framing.at("min_width_m").get<double>(), render::kGroupFraming.min_width_m);
  EXPECT_EQ(framing.at("margin_m").get<double>(), render::kGroupFraming.margin_m);
  EXPECT_EQ(framing.at("narrowest_aspect").get<double>(), render::kGroupFraming.narrowest_aspect);
  EXPECT_EQ(framing.at("height_m").get<double>(), render::kGroupFraming.height_m);
  std::map<std::string, int> views;
  for (const auto& view : page.at("views")) {
    const std::string name = view.at("name");
    const render::Camera of_group =
        render::NamedCameraAt(name, {Vector3d::Zero(), view.at("radius").get<double>()});
    const render::Camera camera = render::ForAspect(
        render::Turned(of_group, view.value("heading", 0.0)), view.at("aspect").get<double>());
    EXPECT_NEAR((camera.position - ToVector(view.at("position"))).norm(), 0, 1e-5) << view;
    EXPECT_NEAR((camera.target - ToVector(view.at("target"))).norm(), 0, 1e-9) << view;
    EXPECT_NEAR((camera.up - ToVector(view.at("up"))).norm(), 0, 1e-9) << view;
    EXPECT_NEAR(camera.vertical_fov_rad, view.at("vertical_fov_rad").get<double>(), 1e-9) << view;
    ++views[name];
  }
  for (const std::string& name : render::CameraNames()) EXPECT_GT(views[name], 1) << name;
}

TEST(NamedViews, OfScenesWithoutPeopleMatchThePageToo) {
  std::ifstream file(InSourceTree("tests/browser/unit/named_views.json"));
  const nlohmann::json page = nlohmann::json::parse(file);
  ASSERT_GT(page.at("extents").size(), 1u);
  for (const auto& view : page.at("extents")) {
    SceneState state;
    state.extent = {ToVector(view.at("min")), ToVector(view.at("max"))};
    const render::Camera camera = render::WithWholeExtent(
        render::NamedCamera(view.at("name"), state), view.at("aspect").get<double>());
    EXPECT_NEAR((camera.position - ToVector(view.at("position"))).norm(), 0, 1e-5) << view;
    EXPECT_NEAR((camera.target - ToVector(view.at("target"))).norm(), 0, 1e-9) << view;
  }
}

// RViz's orbit: perspective with a field of view of 45 degrees, about a point that goes with the
// target frame but does not turn with it.
TEST(NamedViews, AreContainedInTheRvizConfiguration) {
  const YAML::Node saved = YAML::LoadFile(
      InSourceTree("launch/kinescope.rviz").string())["Visualization Manager"]["Views"]["Saved"];
  const SceneState standing = kinescope::testing::SceneWith(kinescope::testing::Posture::kStanding);
  const Vector3d pelvis = standing.people[0].links[urdf::kPelvis].position;
  std::map<std::string, YAML::Node> by_name;
  for (const YAML::Node& view : saved) by_name[view["Name"].as<std::string>()] = view;
  for (const std::string& name : render::CameraNames()) {
    ASSERT_EQ(by_name.count(name), 1u) << name;
    const YAML::Node& view = by_name[name];
    EXPECT_EQ(view["Class"].as<std::string>(), "rviz/Orbit");
    EXPECT_EQ(view["Target Frame"].as<std::string>(), "skeleton_pelvis");
    const render::Camera camera =
        render::WithFov(render::NamedCamera(name, standing), 45 * M_PI / 180);
    const YAML::Node& point = view["Focal Point"];
    const Vector3d focus = pelvis + Vector3d(point["X"].as<double>(), point["Y"].as<double>(),
                                             point["Z"].as<double>());
    EXPECT_NEAR((focus - camera.target).norm(), 0, 0.005) << name << ": " << camera.target;
    const double yaw = view["Yaw"].as<double>(), pitch = view["Pitch"].as<double>();
    const Vector3d eye = focus + view["Distance"].as<double>() *
                                     Vector3d(std::cos(pitch) * std::cos(yaw),
                                              std::cos(pitch) * std::sin(yaw), std::sin(pitch));
    EXPECT_NEAR((eye - camera.position).norm(), 0, 0.01) << name;
    // At its pole the orbit's yaw says what is up.
    const Vector3d up = pitch > 1.5 ? Vector3d(-std::cos(yaw), -std::sin(yaw), 0) : camera.up;
    EXPECT_NEAR((up - camera.up).norm(), 0, 1e-3) << name;
  }
}

}  // namespace
}  // namespace kinescope::app
