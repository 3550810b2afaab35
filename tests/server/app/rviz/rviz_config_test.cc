// The configuration of RViz for what runs, made from the one that we ship.
#include "server/app/rviz/rviz_config.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include "tests/folders.h"

namespace kinescope::app {
namespace {

std::string Usual() {
  std::ifstream file(kinescope::testing::InSourceTree("launch/kinescope.rviz"));
  return {std::istreambuf_iterator<char>(file), {}};
}

std::map<std::string, YAML::Node> DisplaysByName(const std::string& text) {
  std::map<std::string, YAML::Node> displays;
  for (const YAML::Node& display : YAML::Load(text)["Visualization Manager"]["Displays"]) {
    displays[display["Name"].as<std::string>()] = display;
  }
  return displays;
}

TEST(RvizConfig, ShowsEveryPersonOfTheNode) {
  const std::string text = RvizConfig(Usual(),
                                      {"/lab/suits",
                                       "lab: \"one\"",
                                       true,
                                       true,
                                       {{"anna", "/human_description", "/lab/suits/"},
                                        {"ben", "/ben/robot_description", "/lab/suits/ben/"}}},
                                      /*with_view=*/true);
  auto displays = DisplaysByName(text);
  EXPECT_EQ(displays.size(), DisplaysByName(Usual()).size() + 2);
  EXPECT_EQ(displays["Body of anna"]["Robot Description"].as<std::string>(), "/human_description");
  EXPECT_EQ(displays["Body of ben"]["Robot Description"].as<std::string>(),
            "/ben/robot_description");
  EXPECT_EQ(displays["Loads of anna"]["Marker Topic"].as<std::string>(), "/lab/suits/markers");
  EXPECT_EQ(displays["Loads of ben"]["Marker Topic"].as<std::string>(), "/lab/suits/ben/markers");
  EXPECT_EQ(displays["Kinescope's view"]["Image Topic"].as<std::string>(),
            "/lab/suits/view/image_raw");
  EXPECT_TRUE(displays["Kinescope's view"]["Enabled"].as<bool>());
  const YAML::Node manager = YAML::Load(text)["Visualization Manager"];
  EXPECT_EQ(manager["Global Options"]["Fixed Frame"].as<std::string>(), "lab: \"one\"");
  EXPECT_EQ(manager["Views"]["Current"]["Target Frame"].as<std::string>(), "anna_pelvis");
  for (const YAML::Node& view : manager["Views"]["Saved"]) {
    EXPECT_EQ(view["Target Frame"].as<std::string>(), "anna_pelvis") << view["Name"];
  }
}

TEST(RvizConfig, HasNoViewWhereNoneIsPublished) {
  const auto displays = DisplaysByName(RvizConfig(
      Usual(),
      {"/kinescope", "world", true, false, {{"skeleton", "/robot_description", "/kinescope/"}}},
      /*with_view=*/true));
  EXPECT_EQ(displays.count("Kinescope's view"), 0U);
  EXPECT_EQ(displays.count("Floor"), 1U);
}

TEST(RvizConfig, HasTheViewOnlyWhereItIsAskedFor) {
  const auto displays = DisplaysByName(RvizConfig(
      Usual(),
      {"/kinescope", "world", true, true, {{"skeleton", "/robot_description", "/kinescope/"}}}));
  EXPECT_EQ(displays.count("Kinescope's view"), 0U);
  EXPECT_EQ(DisplaysByName(Usual())["Kinescope's view"]["Image Topic"].as<std::string>(), "");
}

}  // namespace
}  // namespace kinescope::app
