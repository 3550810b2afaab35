#include "server/picture/rviz_file.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <string>

#include "core/system/errors.h"
#include "server/picture/camera_options.h"
#include "tests/server/picture/rviz_fixture.h"
#include "tests/shared_data.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;
using kinescope::testing::kRvizHeight;
using kinescope::testing::ReadText;
using kinescope::testing::SettingsOf;
using kinescope::testing::SharedData;
using kinescope::testing::WithDisplays;
using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

std::string RefusalOfText(const std::string& text) {
  try {
    ReadText(text);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "it was read";
}

TEST(RvizFile, SaysBackgroundFloorAndPartsAsOptions) {
  const auto settings = SettingsOf(ReadText(WithDisplays(
      "    - {Class: rviz/Grid, Enabled: true, Name: Grid}\n"
      "    - {Class: rviz/RobotModel, Enabled: true, Name: Person}\n"
      "    - {Class: rviz/TF, Enabled: true, Name: TF, Show Names: false, Show Arrows: false}\n"
      "    - {Class: rviz/MarkerArray, Enabled: true, Name: Loads, Marker Topic: /lab/markers,\n"
      "       Namespaces: {com: false}}\n",
      "  Global Options: {Background Color: 177; 255; 255, Fixed Frame: /world}\n")));
  EXPECT_EQ(settings.at("background"), "#b1ffff");
  EXPECT_EQ(settings.at("theme"), "light");
  EXPECT_EQ(settings.at("floor"), "on");
  EXPECT_EQ(settings.at("figure"), "urdf");
  EXPECT_EQ(settings.at("hide"), "shadows,com");
  EXPECT_EQ(settings.at("show"), "link_frames");
}

TEST(RvizFile, HidesWhatNoDisplayShows) {
  const auto settings = SettingsOf(ReadText(WithDisplays("    []\n")));
  EXPECT_EQ(settings.at("background"), "#303030") << "RViz's own";
  EXPECT_EQ(settings.at("theme"), "dark");
  EXPECT_EQ(settings.at("floor"), "off");
  EXPECT_EQ(settings.at("hide"), "shadows,body,markers,loads,com,cop,support,forces,hand_loads");
  EXPECT_EQ(settings.count("show"), 0U);
}

TEST(RvizFile, ShowsLoadsOnlyWhereADisplayHasOurMarkers) {
  const auto hidden = [](const std::string& more) {
    return SettingsOf(ReadText(
        WithDisplays("    - {Class: rviz/MarkerArray, Enabled: true, " + more + "}\n")))["hide"];
  };
  const std::string all = "shadows,body,loads,com,cop,support,forces,hand_loads";
  EXPECT_EQ(hidden("Marker Topic: /city"), all);
  EXPECT_EQ(hidden("Marker Topic: /city, Namespaces: {walls: true}"), all);
  EXPECT_EQ(hidden("Marker Topic: /kinescope/markers"), "shadows,body");
  EXPECT_EQ(hidden("Marker Topic: /lab/anna/markers, Namespaces: {loads: false}"),
            "shadows,body,loads");
  EXPECT_EQ(hidden("Marker Topic: /kinescope/markers, Namespaces: {foot_forces: false}"),
            "shadows,body,forces")
      << "the name of the namespace, not of the part";
  EXPECT_EQ(hidden("Marker Topic: /carla/markers, Namespaces: {\"\": true}"), all);
  EXPECT_EQ(hidden("Marker Topic: /viz, Namespaces: {com: false}"), all);
}

TEST(RvizFile, SaysThatNoPersonIsSeen) {
  const auto remarks = [](const std::string& displays) {
    return ReadText(WithDisplays(displays)).remarks;
  };
  EXPECT_THAT(remarks("    - {Class: rviz/Grid, Enabled: true}\n"),
              Contains(HasSubstr("no display that is on shows people")));
  EXPECT_THAT(remarks("    - {Class: rviz/RobotModel, Enabled: true, Name: Me, Alpha: abc}\n"),
              Contains(HasSubstr("'Me': Alpha abc is 0: it is not seen")));
  EXPECT_THAT(remarks("    - {Class: rviz/RobotModel, Enabled: true}\n"),
              ElementsAre(HasSubstr("no Class")));
}

TEST(RvizFile, NamesWhatIsNotDrawnWithItsLineAndLeavesOutWhatIsOff) {
  const RvizPicture picture = ReadText(
      WithDisplays("    - {Class: rviz/Path, Enabled: true, Name: Plan}\n"
                   "    - {Class: rviz/Map, Enabled: false, Name: Map}\n"
                   "    - Class: rviz/Group\n"
                   "      Enabled: false\n"
                   "      Displays: [{Class: rviz/Odometry, Enabled: true, Name: Wheels}]\n"
                   "    - Class: rviz/Group\n"
                   "      Enabled: true\n"
                   "      Displays: [{Class: jsk/Overlay, Enabled: no, Name: Words}]\n"
                   "    - {class: rviz/Image, Enabled: true, Name: lower case}\n"));
  EXPECT_THAT(picture.remarks,
              ElementsAre("saved.rviz:3: rviz/Path 'Plan' is not drawn: it has no topic",
                          "saved.rviz:10: jsk/Overlay 'Words' is not drawn",
                          "saved.rviz:11: a display without a Class 'lower case' is not drawn",
                          HasSubstr("no display that is on shows people"),
                          HasSubstr("the current view has no Class")));
}

TEST(RvizFile, NamesWhatIsOfAnotherType) {
  EXPECT_THAT(ReadText("Visualization Manager:\n"
                       "  Global Options: hello\n"
                       "  Displays: 5\n"
                       "  Views: 7\n")
                  .remarks,
              ElementsAre("saved.rviz:2: Global Options is no map: nothing of it is taken",
                          "saved.rviz:4: Views is no map: nothing of it is taken",
                          "saved.rviz:3: Displays is no list: none is drawn",
                          HasSubstr("no display that is on shows people"),
                          HasSubstr("10 m away); the file may be cut off: RViz ends it with "
                                    "Window Geometry")));
  EXPECT_THAT(
      ReadText("Visualization Manager:\n"
               "  Displays:\n"
               "    - 5\n"
               "    - [a]\n"
               "Window Geometry: {}\n")
          .remarks,
      ElementsAre("saved.rviz:3: an entry of Displays that is no map is left out",
                  "saved.rviz:4: an entry of Displays that is no map is left out",
                  HasSubstr("no display that is on shows people"), Not(HasSubstr("cut off"))));
}

// Found by the fuzzer.
TEST(RvizFile, SaysNothingThatATerminalObeys) {
  const RvizPicture picture = ReadText(
      WithDisplays("    - {Class: \"plugin/\\e[31m\", Enabled: true, Name: \"two\\nlines\"}\n"));
  EXPECT_THAT(picture.remarks, Each(::testing::Not(HasSubstr("\x1b"))));
  EXPECT_THAT(picture.remarks, Each(::testing::Not(HasSubstr("\n"))));
}

TEST(RvizFile, IsRefusedWithPlaceAndReason) {
  EXPECT_EQ(RefusalOfText("[1, 2"),
            "saved.rviz:1: not valid YAML (end of sequence flow not found)");
  EXPECT_EQ(RefusalOfText("Panels: []\n"),
            "saved.rviz is no configuration of RViz: it has no 'Visualization Manager'");
  EXPECT_EQ(
      RefusalOfText(WithDisplays("    - {Class: rviz_default_plugins/Grid}\n")),
      "saved.rviz:3: is a configuration of RViz 2 ('rviz_default_plugins/Grid'); save one with "
      "RViz 1");
  EXPECT_THAT(RefusalOfText(std::string(200, '[')), HasSubstr("too many levels; at most 100"));
}

TEST(RvizFile, SaysWhatIsLimited) {
  const std::string cloud = "    - {Enabled: true, Name: A, Class: rviz/PointCloud2, Topic: /c, ";
  const RvizPicture picture =
      ReadText(WithDisplays(cloud + "Decay Time: 1000, Size (m): 0.0005}\n"));
  EXPECT_EQ(picture.topics.at(0).style, "(size=0.001,decay=600)");
  EXPECT_THAT(picture.remarks, Contains(HasSubstr("'A': Decay Time 1000 is taken as 600")));
}

TEST(RvizFile, ShowsNothingWhereAllDisplaysAreOff) {
  const RvizPicture picture = ReadText(
      WithDisplays("    - {Class: rviz/Path, Enabled: true, Topic: /a}\n", "  Enabled: false\n"));
  EXPECT_TRUE(picture.topics.empty());
}

TEST(RvizFile, HasTheAlphaOfTheFirstModelForPeople) {
  const auto opacity_of = [](const std::string& first) {
    auto settings = SettingsOf(
        ReadText(WithDisplays("    - {Class: rviz/RobotModel, Enabled: true" + first +
                              "}\n    - {Class: rviz/RobotModel, Enabled: true, Alpha: 0.25}\n")));
    return settings["body_opacity"];
  };
  EXPECT_EQ(opacity_of(", Alpha: 0.5"), "0.5");
  EXPECT_EQ(opacity_of(", Alpha: 1"), "");
}

TEST(RvizFile, ShowsTopicsAlsoWithoutADisplayOfMarkers) {
  const auto hidden_of = [](const std::string& display) {
    return SettingsOf(ReadText(WithDisplays("    - {" + display + "}\n"))).at("hide");
  };
  EXPECT_THAT(hidden_of("Class: rviz/PointCloud2, Enabled: true, Topic: /cloud"),
              Not(HasSubstr("markers")));
  EXPECT_THAT(hidden_of("Class: rviz/Axes, Enabled: true"), Not(HasSubstr("markers")));
  EXPECT_THAT(hidden_of("Class: rviz/Grid, Enabled: true"), Not(HasSubstr("markers")));
  EXPECT_THAT(hidden_of("Class: rviz/Grid, Enabled: false"), HasSubstr("markers"));
}

TEST(RvizFile, HasTheModelsThatAGraphDescribes) {
  const RvizPicture picture = ReadText(R"(
Visualization Manager:
  Displays:
    - {Class: rviz/RobotModel, Enabled: true, Name: Human, Robot Description: human_description}
    - {Class: rviz/RobotModel, Enabled: false, Name: Off, Robot Description: other}
    - {Class: rviz/RobotModel, Enabled: true, Name: Arm, TF Prefix: lab/arm}
    - {Class: rviz/RobotModel, Enabled: true, Name: Bad, Robot Description: a b}
)");
  ASSERT_EQ(picture.robots.size(), 2u);
  EXPECT_EQ(picture.robots[0].option, "ros:human_description");
  EXPECT_EQ(picture.robots[1].option, "ros:robot_description@tf:lab/arm");
  EXPECT_EQ(picture.robots[1].display, "rviz/RobotModel 'Arm'");
  EXPECT_EQ(picture.robots[1].line, 6);
  EXPECT_THAT(picture.remarks, Contains(HasSubstr("rviz/RobotModel 'Bad' is not drawn: 'a b'")));
}

TEST(RvizFile, ReadsWhatOthersSavedAsRvizItselfDoes) {
  KINESCOPE_NEEDS_SHARED_DATA("rviz");
  const fs::path folder = SharedData("rviz");
  int read = 0;
  for (const auto& entry : fs::directory_iterator(folder / "resaved-1.14.19")) {
    const fs::path original = folder / entry.path().filename();
    if (!fs::exists(original)) continue;
    auto ours = SettingsOf(ReadRvizFile(original, kRvizHeight));
    auto resaved = SettingsOf(ReadRvizFile(entry.path(), kRvizHeight));
    for (const char* option : {"background", "theme", "floor", "projection"}) {
      EXPECT_EQ(ours[option], resaved[option]) << original << " " << option;
    }
    EXPECT_NEAR(std::stod(ours["fov"]), std::stod(resaved["fov"]), 1e-5) << original;
    const auto camera = ParseCamera(ours["camera"]).place,
               again = ParseCamera(resaved["camera"]).place;
    ASSERT_TRUE(camera && again) << original;  // RViz writes single precision
    EXPECT_LT((camera->position - again->position).norm(), 1e-5) << original;
    EXPECT_LT((camera->target - again->target).norm(), 1e-5) << original;
    EXPECT_LT((camera->up - again->up).norm(), 1e-5) << original;
    ++read;
  }
  EXPECT_GE(read, 15);
}

}  // namespace
}  // namespace kinescope::app
