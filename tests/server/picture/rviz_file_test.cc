#include "server/picture/rviz_file.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "core/system/errors.h"
#include "render/camera/camera.h"
#include "server/options/ros_names.h"
#include "server/picture/camera_options.h"
#include "server/picture/rviz_option.h"
#include "tests/captured_log.h"
#include "tests/shared_data.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using kinescope::testing::SharedData;
using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr int kPictureWidth = 800, kPictureHeight = 600;  // px

std::map<std::string, std::string> SettingsOf(const RvizPicture& picture) {
  std::map<std::string, std::string> settings;
  for (const auto& each : picture.settings) {
    EXPECT_TRUE(settings.emplace(each.option, each.text).second) << each.option << " twice";
  }
  return settings;
}

RvizPicture ReadText(const std::string& text) {
  return ParseRvizFile("saved.rviz", text, kPictureHeight);
}

/// A configuration with these displays, and more lines of the manager.
std::string WithDisplays(const std::string& displays, const std::string& more = "") {
  return "Visualization Manager:\n  Displays:\n" + displays + more;
}

std::string WithView(const std::string& lines) {
  return "Visualization Manager:\n  Views:\n    Current:\n" + lines;
}

/// The camera as the options of a picture make it.
render::Camera CameraOf(const std::string& view) {
  const auto settings = SettingsOf(ReadText(WithView(view)));
  render::Camera camera = ParseCamera(settings.at("camera")).place.value();
  camera.vertical_fov_rad = std::stod(settings.at("fov")) * M_PI / 180;
  return settings.at("projection") == "orthographic" ? render::Orthographic(camera) : camera;
}

render::Projected Seen(const Vector3d& point, const render::Camera& camera) {
  return render::Project(point, camera, kPictureWidth, kPictureHeight);
}

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

// Found by the fuzzer.
TEST(RvizFile, SaysNothingThatATerminalObeys) {
  const RvizPicture picture = ReadText(
      WithDisplays("    - {Class: \"plugin/\\e[31m\", Enabled: true, Name: \"two\\nlines\"}\n"));
  EXPECT_THAT(picture.remarks, Each(::testing::Not(HasSubstr("\x1b"))));
  EXPECT_THAT(picture.remarks, Each(::testing::Not(HasSubstr("\n"))));
}

TEST(RvizFile, OrbitStandsWhereRvizHasIt) {
  const render::Camera camera = CameraOf(
      "      {Class: rviz/Orbit, Distance: 5, Yaw: 0, Pitch: 0.5, Field of View: 0.9,\n"
      "       Focal Point: {X: 1, Y: 2, Z: 0.5}}\n");
  EXPECT_LT((camera.position - Vector3d(1 + 5 * std::cos(0.5), 2, 0.5 + 5 * std::sin(0.5))).norm(),
            1e-9);
  EXPECT_LT((camera.target - Vector3d(1, 2, 0.5)).norm(), 1e-9);
  EXPECT_NEAR(camera.vertical_fov_rad, 0.9, 1e-9);
}

TEST(RvizFile, OrbitUpsideDownHasItsCameraBelow) {
  const render::Camera camera =
      CameraOf("      {Class: rviz/Orbit, Distance: 5, Yaw: 0, Pitch: 0.5, Invert Z Axis: true}\n");
  EXPECT_LT(camera.position.z(), -2);
  EXPECT_GT(Seen({0, 0, 1}, camera).y_px, kPictureHeight / 2.0) << "what is high is below";
}

// Measured in RViz: the point is 24 % of the height below the middle.
TEST(RvizFile, XyOrbitShowsItsFocusBelowTheMiddle) {
  for (const char* kind : {"rviz/XYOrbit", "rviz/ThirdPersonFollower"}) {
    const render::Camera camera =
        CameraOf("      {Class: " + std::string(kind) + ", Distance: 5, Yaw: 0.3, Pitch: 0.6}\n");
    const render::Projected focus = Seen(Vector3d::Zero(), camera);
    EXPECT_NEAR(focus.x_px, kPictureWidth / 2.0, 1e-6);
    EXPECT_NEAR(focus.y_px / kPictureHeight, 0.5 + 0.2 / std::tan(M_PI / 8) / 2, 1e-6);
  }
}

TEST(RvizFile, FirstPersonLooksDownWithPitchAndLeansWithRoll) {
  const render::Camera camera = CameraOf(
      "      {Class: rviz/FPS, Yaw: 1.5707963267948966, Pitch: 0.5, Roll: 0,\n"
      "       Position: {X: 0, Y: 0, Z: 2}}\n");
  const Vector3d ahead = (camera.target - camera.position).normalized();
  EXPECT_LT((ahead - Vector3d(0, std::cos(0.5), -std::sin(0.5))).norm(), 1e-6);
  const render::Camera leaning = CameraOf("      {Class: rviz/FPS, Roll: 0.5}\n");
  EXPECT_LT((leaning.up - Vector3d(0, -std::sin(0.5), std::cos(0.5))).norm(), 1e-6);
}

TEST(RvizFile, TopDownHasPixelsPerMetre) {
  const render::Camera camera =
      CameraOf("      {Class: rviz/TopDownOrtho, Scale: 100, Angle: 0, X: 1, Y: 2}\n");
  const render::Projected middle = Seen({1, 2, 0}, camera), right = Seen({2, 2, 0}, camera),
                          up = Seen({1, 3, 1.8}, camera);
  EXPECT_NEAR(middle.x_px, kPictureWidth / 2.0, 1e-3);
  EXPECT_NEAR(middle.y_px, kPictureHeight / 2.0, 1e-3);
  EXPECT_NEAR(right.x_px - middle.x_px, 100, 1e-3);
  EXPECT_NEAR(middle.y_px - up.y_px, 100, 1e-3);
}

TEST(RvizFile, TopDownTurnsWithItsAngle) {
  const render::Camera camera =
      CameraOf("      {Class: rviz/TopDownOrtho, Scale: 50, Angle: 0.5}\n");
  EXPECT_LT(Seen({0, 0, 0}, camera).y_px, Seen({1, 0, 0}, camera).y_px)
      << "the scene turns the other way: +x points down to the right";
}

TEST(RvizFile, ReadsValuesAsRvizDoes) {
  const auto camera = CameraOf(
      "      {Class: rviz/Orbit, Distance: five, Yaw: 0, Pitch: 9, Focal Point: {X: 1, Y: 2}}\n");
  EXPECT_NEAR(camera.position.norm(), 0.001, 1e-9)
      << "0, which is too near, from a point without Z";
  const auto settings = SettingsOf(ReadText(
      WithDisplays("    - {Class: rviz/Grid, Enabled: no, Name: any text but false is true}\n",
                   "  Global Options: {Background Color: 300; -5; 7}\n")));
  EXPECT_EQ(settings.at("floor"), "on");
  EXPECT_EQ(settings.at("background"), "#ff0007");
}

TEST(RvizFile, NamesAViewThatIsNotOfRviz) {
  const RvizPicture picture =
      ReadText(WithView("      {Class: plugin/Animated, Target Frame: base_link}\n"));
  EXPECT_THAT(picture.remarks, Contains(HasSubstr("4: the view 'plugin/Animated' is not one of")));
}

TEST(RvizFile, HasTheFrameThatTheViewGoesWith) {
  const auto target_of = [](const std::string& view) {
    const RvizPicture::Target target = ReadText(WithView("      {" + view + "}\n")).target;
    return target.frame + target.turn;
  };
  EXPECT_EQ(target_of("Class: rviz/Orbit, Target Frame: /base_link"), "base_link");
  EXPECT_EQ(target_of("Class: rviz/Orbit, Target Frame: <Fixed Frame>"), "");
  EXPECT_EQ(target_of("Class: rviz/XYOrbit, Target Frame: map"), "") << "it is the fixed frame";
  EXPECT_EQ(target_of("Class: rviz/ThirdPersonFollower, Target Frame: cart"), "cart:heading");
  EXPECT_EQ(target_of("Class: rviz/FrameAligned, Target Frame: cam"), "cam:pose");
}

TEST(RvizFile, IsRefusedWithPlaceAndReason) {
  EXPECT_EQ(RefusalOfText("[1, 2"),
            "saved.rviz:1: not valid YAML (end of sequence flow not found)");
  EXPECT_EQ(RefusalOfText("Panels: []\n"),
            "saved.rviz: is no configuration of RViz: it has no 'Visualization Manager'");
  EXPECT_EQ(
      RefusalOfText(WithDisplays("    - {Class: rviz_default_plugins/Grid}\n")),
      "saved.rviz:3: is a configuration of RViz 2 ('rviz_default_plugins/Grid'); save one with "
      "RViz 1");
  EXPECT_THAT(RefusalOfText(std::string(200, '[')), HasSubstr("too many levels; at most 100"));
}

TEST(RvizFile, HasTheTopicsOfDisplaysThatAreOn) {
  const RvizPicture picture = ReadText(R"(
Visualization Manager:
  Displays:
    - {Class: rviz/Pose, Enabled: true, Name: Goal, Topic: /move/goal}
    - {Class: rviz/PointCloud2, Enabled: false, Name: Depth, Topic: /depth/points}
    - {Class: rviz/MarkerArray, Enabled: true, Name: Walls, Marker Topic: walls}
    - Class: rviz/Group
      Enabled: true
      Displays:
        - {Class: rviz/Path, Enabled: true, Name: Plan, Topic: /plan}
        - {Class: rviz/LaserScan, Enabled: true, Name: Scan, Topic: "/scan;rm"}
        - {Class: rviz/Odometry, Enabled: true, Name: Odometry, Topic: /odom}
)");
  ASSERT_EQ(picture.topics.size(), 4u);
  EXPECT_EQ(picture.topics[0].name, "/move/goal");
  EXPECT_EQ(picture.topics[0].display, "rviz/Pose 'Goal'");
  EXPECT_EQ(picture.topics[0].line, 4);
  EXPECT_FALSE(picture.topics[1].is_of_people);
  EXPECT_EQ(picture.topics[2].name, "/plan");
  EXPECT_EQ(picture.topics[2].style, "");
  EXPECT_THAT(picture.remarks, Contains(HasSubstr("'/scan;rm' is no name of a topic")));
  EXPECT_EQ(picture.topics[3].name, "/odom");
  EXPECT_THAT(picture.topics[3].style, HasSubstr(",keep=100,step=0.1,turn=0.1)"));
}

TEST(RvizFile, HasColoursOpacityAndSizesOfDisplays) {
  const RvizPicture picture = ReadText(R"(
Visualization Manager:
  Displays:
    - {Class: rviz/PointStamped, Enabled: true, Topic: /a, Color: 255; 0; 16, Alpha: 0.5, Radius: 0.1}
    - {Class: rviz/Pose, Enabled: true, Topic: /b, Shape: Axes, Shaft Length: 0.5, Axes Length: 0.4}
    - {Class: rviz/Path, Enabled: true, Topic: /c, Color: 25; 255; 0, Line Style: Lines, Line Width: 0.2}
    - {Class: rviz/Path, Enabled: true, Topic: /d, Line Style: Billboards, Line Width: 0.2, Pose Style: Axes}
    - {Class: rviz/PointCloud2, Enabled: true, Topic: /e, Color Transformer: FlatColor,
       Color: "#00ff80", Style: Boxes, Size (m): 0.03}
    - {Class: rviz/PointCloud2, Enabled: true, Topic: /f, Color Transformer: RGB8,
       Color: 1; 2; 3, Style: Points, Size (m): 0.03, Size (Pixels): 5}
    - {Class: rviz/LaserScan, Enabled: true, Topic: /g, Color Transformer: AxisColor, Size (m): -1}
    - {Class: rviz/WrenchStamped, Enabled: true, Topic: /h, Force Color: 1; 2; 3}
    - {Class: rviz/PoseArray, Enabled: true, Topic: /i, Arrow Length: 0.5}
    - {Class: rviz/Pose, Enabled: true, Topic: /j, Shaft Length: 9, Head Length: 8}
    - {Class: rviz/Odometry, Enabled: true, Topic: /k, Keep: 1, Covariance: {Value: true},
       Shape: {Value: Arrow, Color: 0; 0; 255, Alpha: 0.5, Shaft Length: 0.5, Head Length: 0.25}}
    - {Class: rviz/Map, Enabled: true, Topic: /l, Color Scheme: costmap, Alpha: 0.25, Draw Behind: true}
    - {Class: rviz/Map, Enabled: true, Topic: /m, Color Scheme: raw}
    - {Class: rviz/Polygon, Enabled: true, Topic: /n, Color: 25; 255; 0}
    - {Class: rviz/PointCloud2, Enabled: true, Topic: /o, Color Transformer: AxisColor, Axis: X, Use Fixed Frame: false,
       Autocompute Value Bounds: {Max Value: 2.5, Min Value: -1, Value: false}, Invert Rainbow: true}
    - {Class: rviz/PointCloud2, Enabled: true, Topic: /p, Color Transformer: Intensity, Invert Rainbow: true}
    - {Class: rviz/LaserScan, Enabled: true, Topic: /q, Color Transformer: Intensity, Channel Name: ring, Use rainbow: false,
       Autocompute Intensity Bounds: false, Min Color: 0; 0; 255, Max Color: 255; 0; 0, Max Intensity: 1e15, Min Intensity: 5}
    - {Class: rviz/PointCloud, Enabled: true, Topic: /r, Color Transformer: Intensity, Channel Name: "my,ring"}
    - {Class: rviz/PointCloud2, Enabled: true, Topic: /s, Color Transformer: MONO8}
)");
  std::vector<std::string> styles;
  std::string all, others;
  for (const RvizPicture::Topic& topic : picture.topics) {
    styles.push_back(topic.style);
    std::string& half = styles.size() <= 14 ? all : others;
    half += (half.empty() ? "" : ",") + topic.name + topic.style;
  }
  EXPECT_THAT(
      styles,
      ElementsAre("(color=#ff0010,alpha=0.5,size=0.1)", "(shape=axes,size=0.4)", "(color=#19ff00)",
                  "(shape=axes,pose_size=0.3,size=0.2)", "(color=#00ff80,shape=cubes,size=0.03)",
                  "(pixels=5)", "(by=z)", "(color=#010203,force=2.6,torque=2.6,width=0.5)",
                  "(size=0.5)", "(head=8,size=10)",
                  "(color=#0000ff,alpha=0.5,head=0.25,size=0.75,covariance=1,covariance_alpha=0.3,"
                  "covariance_"
                  "color=#cc33cc,turn_covariance=1,turn_covariance_alpha=0.5,turn_covariance_"
                  "offset=1,turn_covariance_color=#ffff7f,keep=1,step=0.1,turn=0.1)",
                  "(alpha=0.25,scheme=costmap,updates=on)", "(updates=on)", "(color=#19ff00)",
                  "(by=x,from=-1,to=2.5)", "(by=intensity,rainbow=inverted)",
                  "(by=ring,from=5,to=1000000000000,low=#0000ff,high=#ff0000)", "(by=_)", ""));
  for (const char* remark : {"Draw Behind: it is drawn in", "an arrow of 17 m is drawn with 10 m",
                             "Color Scheme 'raw' is drawn as 'map'",
                             "Use Fixed Frame 'false': the axis is that of the scene",
                             "Channel Name 'my,ring' cannot be taken; its points are white",
                             "Color Transformer 'MONO8' is not taken"}) {
    EXPECT_THAT(picture.remarks, Contains(HasSubstr(remark)));
  }
  ShownTopicsValue value;
  value.Parse(all);
  ASSERT_EQ(value->size(), 14u);
  EXPECT_TRUE((*value)[1].style.has_axes);
  EXPECT_TRUE((*value)[11].style.is_costmap);
  EXPECT_TRUE((*value)[11].style.has_updates);
  EXPECT_TRUE((*value)[12].style.has_updates);
  EXPECT_FALSE((*value)[13].style.has_updates);
  EXPECT_EQ((*value)[0].style.alpha, 0.5);
  EXPECT_EQ((*value)[0].style.size_m, 0.1);
  EXPECT_EQ(((*value)[4].style.color), (Rgb{0, 1, 128 / 255.0}));
  EXPECT_EQ((*value)[4].style.size_px, std::nullopt);
  EXPECT_EQ((*value)[5].style.size_px, 5);
  EXPECT_EQ((*value)[8].name, "/i");
  value.Parse(others);
  ASSERT_EQ(value->size(), 5u);
  EXPECT_EQ((*value)[0].style.scale->by, "x");
  EXPECT_EQ((*value)[0].style.scale->from, -1);
  EXPECT_TRUE((*value)[1].style.scale->is_inverted);
  EXPECT_EQ((*value)[2].style.scale->to, 1e12);
  EXPECT_EQ(((*value)[2].style.scale->low), (Rgb{0, 0, 1}));
}

TEST(RvizFile, HasPointsInPixelsWithinLimits) {
  const auto style_of = [](const std::string& display) {
    const RvizPicture picture =
        ReadText(WithDisplays("    - {Enabled: true, Name: A, Style: Points, " + display + "}\n"));
    EXPECT_THAT(picture.remarks, Not(Contains(HasSubstr("'A'")))) << display;
    return picture.topics.at(0).style;
  };
  EXPECT_EQ(style_of("Class: rviz/LaserScan, Topic: /a"), "(pixels=3)") << "as RViz has it";
  EXPECT_EQ(style_of("Class: rviz/LaserScan, Topic: /a, Size (Pixels): 0.2"), "(pixels=1)");
  EXPECT_EQ(style_of("Class: rviz/PointCloud, Topic: /a, Size (Pixels): 1e9"), "(pixels=100)");
  EXPECT_EQ(style_of("Class: rviz/DepthCloud, Depth Map Topic: /a, Size (Pixels): 2.5, "
                     "Auto Size: {Value: true}"),
            "(cloud=on,pixels=2.5)");
}

TEST(RvizFile, HasEffortsAsRings) {
  const RvizPicture picture = ReadText(R"(
Visualization Manager:
  Displays:
    - {Class: rviz/Effort, Enabled: true, Topic: /joint_states, Alpha: 0.5, Scale: 2, Width: 0.05, History Length: 1,
       Robot Description: robot_description, TF Prefix: "", Joints: {All Enabled: true, lift: {Effort: 0, Max Effort: 1, Value: true},
       turn: {Value: false}, "a|b": {Value: false}, hand: {Value: false}}}
    - {Class: rviz/Effort, Enabled: true, Name: Arm, Topic: /arm, History Length: 5}
)");
  ASSERT_EQ(picture.topics.size(), 2u);
  EXPECT_EQ(picture.topics[0].style, "(size=2,width=0.05,without=turn|hand)");
  EXPECT_EQ(picture.topics[1].style, "(size=1,width=0.02)");
  EXPECT_THAT(picture.remarks, Contains(HasSubstr("the ring of the joint 'a|b' is not left out")));
  EXPECT_THAT(picture.remarks, Contains(HasSubstr("'Arm': History Length")));
  ShownTopicsValue value;
  value.Parse(picture.topics[0].name + picture.topics[0].style);
  EXPECT_EQ(value->at(0).style.frames.hidden, (std::vector<std::string>{"turn", "hand"}));
}

// As human-dynamics-estimation shows what loads a person: the effort of each joint as the colour of
// a sphere, and the forces on feet and hands.
TEST(RvizFile, HasValuesAsSpheresAndTheArrowsOfWrenches) {
  const RvizPicture picture = ReadText(R"(
Visualization Manager:
  Displays:
    - {Class: rviz/Temperature, Enabled: true, Topic: /effort, Channel Name: temperature, Color Transformer: Intensity,
       Autocompute Intensity Bounds: false, Min Intensity: 0, Max Intensity: 30, Use rainbow: false, Invert Rainbow: true,
       Min Color: 138; 226; 52, Max Color: 239; 41; 41, Style: Spheres, Size (m): 0.15}
    - {Class: rviz/WrenchStamped, Enabled: true, Topic: /foot, Force Color: 255; 239; 6, Torque Color: 37; 95; 255,
       Force Arrow Scale: 0.5, Torque Arrow Scale: 0, Arrow Width: 0.3, Hide Small Values: false}
    - {Class: rviz/WrenchStamped, Enabled: true, Name: Hand, Topic: /hand, Force Arrow Scale: -1, Arrow Width: 1e9}
)");
  ASSERT_EQ(picture.topics.size(), 3u);
  EXPECT_EQ(picture.topics[0].style,
            "(by=temperature,from=0,to=30,low=#8ae234,high=#ef2929,shape=spheres,size=0.15)");
  EXPECT_EQ(picture.topics[1].style,
            "(color=#ffef06,force=0.65,torque=0,width=0.3,torque_color=#255fff,small=shown)");
  EXPECT_EQ(picture.topics[2].style, "(force=0,torque=2.6,width=10)");
  EXPECT_THAT(picture.remarks, Not(Contains(HasSubstr("Temperature"))));
  EXPECT_THAT(picture.remarks, Not(Contains(HasSubstr("Wrench"))));
  ShownTopicsValue value;
  value.Parse(picture.topics[0].name + picture.topics[0].style + "," + picture.topics[1].name +
              picture.topics[1].style);
  ASSERT_EQ(value->size(), 2u);
  EXPECT_TRUE((*value)[0].style.has_spheres);
  EXPECT_EQ((*value)[0].style.scale->by, "temperature");
  EXPECT_EQ((*value)[1].style.wrench.force_m, 0.65);
  EXPECT_FALSE((*value)[1].style.wrench.hides_small);
}

TEST(RvizFile, HasTwistsRangesCovariancesAndPicturesOfCameras) {
  const RvizPicture picture = ReadText(R"(
Visualization Manager:
  Displays:
    - {Class: rviz/TwistStamped, Enabled: true, Topic: /twist, Linear Color: 255; 0; 0, Angular Color: 0; 0; 255,
       Linear Arrow Scale: 1, Angular Arrow Scale: 0, Arrow Width: 0.3}
    - {Class: rviz/Range, Enabled: true, Topic: /sonar, Color: 255; 255; 255, Alpha: 0.5, Buffer Length: 3}
    - Class: rviz/PoseWithCovariance
      Enabled: true
      Name: Place
      Topic: /place
      Covariance:
        Value: true
        Position: {Alpha: 0.5, Color: 204; 51; 204, Scale: 2, Value: true}
        Orientation: {Value: true, Alpha: 0.25, Offset: 2, Color Style: RGB, Frame: Fixed, Scale: 3}
    - {Class: rviz/Camera, Enabled: true, Name: Eye, Image Topic: /eye/image_raw}
)");
  ASSERT_EQ(picture.topics.size(), 4u);
  EXPECT_EQ(picture.topics[0].style,
            "(color=#ff0000,force=1.3,torque=0,width=0.3,torque_color=#0000ff)");
  EXPECT_EQ(picture.topics[1].style, "(color=#ffffff,alpha=0.5,keep=3)");
  EXPECT_EQ(picture.topics[2].style,
            "(covariance=2,covariance_alpha=0.5,covariance_color=#cc33cc,turn_covariance=3,turn_"
            "covariance_alpha=0.25,turn_covariance_offset=2,turn_covariance_color=axes)");
  EXPECT_EQ(picture.topics[3].name + picture.topics[3].style, "/eye/image_raw(scene=0.5)");
  EXPECT_THAT(
      picture.remarks,
      Contains(HasSubstr("'Place': the covariance of the orientation is drawn about the axes of "
                         "the pose, not fixed ones")));
  ShownTopicsValue value;
  value.Parse("/p" + picture.topics[2].style + ",/t(linear=0.5,angular=0)");
  EXPECT_EQ((*value)[0].style.covariance.scale, 2);
  EXPECT_EQ((*value)[0].style.turn_covariance.scale, 3);
  EXPECT_TRUE((*value)[0].style.turn_covariance.has_axis_colors);
  EXPECT_EQ((*value)[1].style.wrench.force_m, 0.5);
  EXPECT_EQ((*value)[1].style.wrench.torque_m, 0);
}

TEST(RvizFile, HasTheSceneOverTheImagesOfCameras) {
  const RvizPicture picture = ReadText(WithDisplays(
      "    - {Class: rviz/Camera, Enabled: true, Name: Usual, Image Topic: /a/image_raw,\n"
      "       Image Rendering: background and overlay, Overlay Alpha: 0.25, Zoom Factor: 1,\n"
      "       Visibility: {Grid: true, Value: true, Robots: {Arm: true, Value: true}}}\n"
      "    - {Class: rviz/Camera, Enabled: true, Name: Behind, Image Topic: /b/image_raw,\n"
      "       Image Rendering: background, Zoom Factor: 2, Transport Hint: compressed,\n"
      "       Visibility: {Grid: true, Plan: false, Value: true}}\n"
      "    - {Class: rviz/Camera, Enabled: true, Name: Front, Image Topic: /c/image_raw,\n"
      "       Image Rendering: overlay}\n"));
  ASSERT_EQ(picture.topics.size(), 3u);
  EXPECT_EQ(picture.topics[0].name + picture.topics[0].style, "/a/image_raw(scene=0.75)");
  EXPECT_EQ(picture.topics[1].name + picture.topics[1].style, "/b/image_raw/compressed(scene=1)");
  EXPECT_EQ(picture.topics[2].style, "(scene=0.5)");
  EXPECT_THAT(picture.remarks,
              ElementsAre(HasSubstr("'Behind': Zoom Factor is not taken"),
                          HasSubstr("'Behind': Visibility is not taken: 'Plan'"),
                          HasSubstr("'Front': Image Rendering 'overlay' is drawn as"),
                          HasSubstr("current view has no Class")));
  ShownTopicsValue value;
  value.Parse("/a" + picture.topics[0].style);
  EXPECT_EQ((*value)[0].style.camera.scene_opacity, 0.75);
  EXPECT_THROW(value.Parse("/a(scene=2)"), options::BadValue);
  EXPECT_THROW(value.Parse("/a(scene=on)"), options::BadValue);
}

TEST(RvizFile, HasCloudsOfDepths) {
  const RvizPicture picture = ReadText(WithDisplays(
      "    - {Class: rviz/DepthCloud, Enabled: true, Name: Plain, Depth Map Topic: /d/image,\n"
      "       Color Image Topic: \"\", Color Transformer: AxisColor, Axis: Z, Style: Flat "
      "Squares,\n"
      "       Autocompute Value Bounds: {Min Value: 0, Max Value: 2, Value: false},\n"
      "       Auto Size: {Auto Size Factor: 1, Value: true}, Size (m): 0.3}\n"
      "    - {Class: rviz/DepthCloud, Enabled: true, Name: Coloured, Depth Map Topic: /d/image,\n"
      "       Color Image Topic: /rgb/image, Color Transformer: AxisColor, Style: Spheres,\n"
      "       Depth Map Transport Hint: compressedDepth, Color Transport Hint: compressed,\n"
      "       Auto Size: {Auto Size Factor: 2, Value: true},\n"
      "       Occlusion Compensation: {Occlusion Time-Out: 30, Value: true}}\n"
      "    - {Class: rviz/DepthCloud, Enabled: true, Name: Sized, Depth Map Topic: /d/image,\n"
      "       Auto Size: {Value: false}, Size (m): 0.02, Style: Boxes, Decay Time: 3}\n"
      "    - {Class: rviz/DepthCloud, Enabled: true, Name: Bare, Depth Map Topic: \"\"}\n"));
  ASSERT_EQ(picture.topics.size(), 3u);
  EXPECT_EQ(picture.topics[0].name + picture.topics[0].style,
            "/d/image(cloud=on,by=z,from=0,to=2)");
  EXPECT_EQ(picture.topics[1].style, "(cloud=on,colors=/rgb/image,shape=spheres)");
  EXPECT_EQ(picture.topics[2].style, "(cloud=on,shape=cubes,size=0.02,decay=3)");
  EXPECT_THAT(
      picture.remarks,
      ElementsAre(HasSubstr("'Coloured': Color Transport Hint 'compressed' is read as 'raw'"),
                  HasSubstr("'Coloured': Auto Size Factor is not taken"),
                  HasSubstr("'Coloured': Occlusion Compensation"),
                  HasSubstr("'Coloured': Depth Map Transport Hint 'compressedDepth' is read as"),
                  HasSubstr("'Bare' is not drawn: it has no topic"),
                  HasSubstr("current view has no Class")));
  ShownTopicsValue value;
  value.Parse("/d" + picture.topics[1].style);
  EXPECT_TRUE((*value)[0].style.camera.is_cloud);
  EXPECT_EQ((*value)[0].style.camera.color_topic, "/rgb/image");
  EXPECT_THROW(value.Parse("/d(cloud=1)"), options::BadValue);
  EXPECT_THROW(value.Parse("/d(colors=no topic)"), options::BadValue);
}

TEST(RvizFile, HasInteractiveMarkersAndSolidArrows) {
  const std::string displays = R"(
Visualization Manager:
  Displays:
    - {Class: rviz/InteractiveMarkers, Enabled: true, Update Topic: /goals/update, Show Descriptions: false,
       Show Axes: true, Enable Transparency: false}
    - {Class: rviz/InteractiveMarkers, Enabled: true, Update Topic: /plain/update}
    - {Class: rviz/PoseArray, Enabled: true, Topic: /grips, Shape: Arrow (3D), Shaft Length: 0.5, Head Length: 0.25}
    - {Class: rviz/Path, Enabled: true, Topic: /plan, Pose Style: Arrows, Head Length: 0.3, Pose Color: 255; 0; 0}
  Tools: [)";
  const auto topics_of = [&](const std::string& tools) {
    return ReadText(displays + tools + "]\n").topics;
  };
  const auto topics = topics_of("{Class: rviz/Interact}, {Class: rviz/MoveCamera}");
  ASSERT_EQ(topics.size(), 4u);
  EXPECT_EQ(topics[0].name + topics[0].style, "/goals/update(names=off,shape=axes,alpha=1)");
  EXPECT_EQ(topics[1].name + topics[1].style, "/plain/update");
  EXPECT_EQ(topics[2].style, "(shape=arrows,head=0.25,size=0.75)");
  EXPECT_EQ(topics[3].style, "(shape=arrows,head=0.3,pose_color=#ff0000,pose_size=0.4)");
  const auto without = topics_of("{Class: rviz/MoveCamera}, {Class: rviz/Interact}");
  EXPECT_EQ(without.at(1).style, "(handles=off)") << "Interact is not the active tool";
  ShownTopicsValue value;
  value.Parse("/a" + topics[3].style + ",/b" + without[1].style);
  EXPECT_TRUE((*value)[0].style.has_arrows);
  EXPECT_EQ((*value)[0].style.poses.size_m, 0.4);
  EXPECT_FALSE((*value)[1].style.has_handles);
}

TEST(RvizFile, LeavesOutNamespacesOfMarkersOfOthers) {
  const RvizPicture picture = ReadText(WithDisplays(
      "    - {Class: rviz/MarkerArray, Enabled: true, Name: City, Marker Topic: /city,\n"
      "       Namespaces: {trees: false, roads: true, com: false, \"my poles\": false, a|b: "
      "false}}\n"));
  ASSERT_EQ(picture.topics.size(), 1u);
  EXPECT_EQ(picture.topics[0].style, "(without=trees|com|my poles)");
  EXPECT_THAT(picture.remarks, ElementsAre(HasSubstr("'City': the namespace 'a|b' is not left out"),
                                           HasSubstr("current view has no Class")));
  ShownTopicsValue value;
  value.Parse("/city" + picture.topics[0].style);
  EXPECT_THAT((*value)[0].style.frames.hidden, ElementsAre("trees", "com", "my poles"));
}

TEST(RvizFile, NamesWhatIsDrawnOtherwise) {
  const auto remarks_of = [](const std::string& display) {
    return ReadText(WithDisplays("    - {Enabled: true, Name: A, " + display + "}\n")).remarks;
  };
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"Class: rviz/Grid, Offset: {X: 0, Y: 0, Z: 1e9}", "its Offset is too far"},
      {"Class: rviz/Grid, Plane Cell Count: 4000, Alpha: 1", "Plane Cell Count 4000 is taken"},
      {"Class: rviz/Grid, Color: red", "Color 'red' is no r; g; b"},
      {"Class: rviz/Grid, Alpha: none", "Alpha none is 0: it is not seen"},
      {"Class: rviz/Path, Topic: /a, Offset: {X: 1, Y: 0, Z: 0}", "Offset is not taken: the path"},
      {"Class: rviz/RobotModel, Collision Enabled: true", "Collision Enabled: collision geometry"},
      {"Class: rviz/RobotModel, Links: {a: {Value: false}, b: {Value: true}, c: {Value: false}}",
       "links that are off are drawn: a and 1 others"},
      {"Class: rviz/RobotModel, Links: {a: {Show Axes: true}, b: {Alpha: 0.5}}",
       "axes, trails and Alpha of single links are not drawn: a and 1 others"},
      {"Class: rviz/Grid, Plane Cell Count: 8000", "Plane Cell Count 8000 is taken as 1000"},
      {"Class: rviz/Grid, Plane Cell Count: 500, Normal Cell Count: 30",
       "Plane Cell Count 500 is taken as 100"},
      {"Class: rviz/TF, Filter (whitelist): arm", "Filter (whitelist) is not taken"},
      {"Class: rviz/Axes, Show Trail: true", "it has no trail"},
      {"Class: rviz/Map, Topic: /a, Draw Behind: 1", "Draw Behind: it is drawn in front"},
      {"Class: rviz/Effort, Topic: /a", "rings are drawn about joints of robots that are shown"},
      {"Class: rviz/Axes, Length: 50", "Length 50 is taken as 10"},
      {"Class: rviz/Image, Image Topic: /a, Normalize Range: false", "Normalize Range is off"}};
  for (const auto& [display, remark] : cases) {
    EXPECT_THAT(remarks_of(display), Contains(HasSubstr("'A': " + remark))) << display;
  }
  for (const std::string plain :
       {"Class: rviz/Grid, Offset: {X: 0, Y: 0, Z: -0.9}, Reference Frame: table, Cell Size: 2",
        "Class: rviz/RobotModel, Links: {a: {Value: true}, All Links Enabled: true}"}) {
    EXPECT_THAT(remarks_of(plain), Not(Contains(HasSubstr("'A'")))) << plain;
  }
}

std::vector<RvizPicture::Topic> TopicsOf(const std::string& display) {
  return ReadText(WithDisplays("    - {Enabled: true, Name: A, " + display + "}\n")).topics;
}

std::string StyleOf(const std::string& display) { return TopicsOf(display).at(0).style; }

// What RViz 1.14 draws of a file that an older one has saved.
TEST(RvizFile, HasDefaultsOfRvizForWhatAnOldFileDoesNotSay) {
  EXPECT_EQ(StyleOf("Class: rviz/Odometry, Topic: /odom, Color: 85; 170; 255, Length: 1"),
            "(covariance=1,covariance_alpha=0.3,covariance_color=#cc33cc,turn_covariance=1,turn_"
            "covariance_alpha=0.5,turn_covariance_offset=1,turn_covariance_color=#ffff7f,keep=100,"
            "step=0.1,turn=0.1)");
  EXPECT_EQ(StyleOf("Class: rviz/PointCloud2, Topic: /c, Color Transformer: FlatColor"),
            "(color=#ffffff)");
  EXPECT_EQ(TopicsOf("Class: rviz/Marker").at(0).name, "visualization_marker");
  EXPECT_EQ(TopicsOf("Class: rviz/MarkerArray").at(0).name, "visualization_marker_array");
  EXPECT_TRUE(TopicsOf("Class: rviz/Marker, Marker Topic: \"\"").empty());
}

TEST(RvizFile, HasMarkersOfTheArrayBesideATopicOfSingleOnes) {
  EXPECT_EQ(StyleOf("Class: rviz/Marker, Marker Topic: /m, Namespaces: {a: false}"),
            "(array=on,without=a)");
  EXPECT_EQ(StyleOf("Class: rviz/MarkerArray, Marker Topic: /m"), "");
  EXPECT_EQ(StyleOf("Class: rviz/MarkerArray, Marker Topic: /m, Namespaces: {\"a;b\": false}"), "");
}

TEST(RvizFile, DoesNotUseTheAlphaOfLines) {
  for (const char* const kind : {"Path", "Polygon", "PoseArray"}) {
    EXPECT_EQ(StyleOf("Class: rviz/" + std::string(kind) + ", Topic: /a, Alpha: 0"), "") << kind;
  }
  EXPECT_EQ(StyleOf("Class: rviz/PoseArray, Topic: /a, Alpha: 0.5, Shape: Axes"),
            "(alpha=0.5,shape=axes)");
}

TEST(RvizFile, HasThePartsOfArrows) {
  EXPECT_EQ(StyleOf("Class: rviz/Pose, Topic: /a, Shaft Length: 2, Shaft Radius: 0.1"),
            "(shaft_width=0.1,head=0.3,size=2.3)");
  EXPECT_EQ(StyleOf("Class: rviz/PoseArray, Topic: /a, Shape: Arrow (3D), Shaft Length: 1, "
                    "Head Length: 0.07, Head Radius: 0.02"),
            "(shape=arrows,head_width=0.02,head=0.07,size=1.07)");
  EXPECT_EQ(StyleOf("Class: rviz/PoseArray, Topic: /a, Shape: Axes, Axes Radius: 0.02"),
            "(shape=axes,width=0.02)");
  ShownTopicsValue value;
  value.Parse("/a(shaft_width=0.1,head=0.3,head_width=0.2,array=on),-*");
  EXPECT_EQ((*value)[0].style.arrow.head_m, 0.3);
  EXPECT_EQ((*value)[0].style.arrow.shaft_width_m, 0.1);
  EXPECT_EQ((*value)[0].style.arrow.head_width_m, 0.2);
  EXPECT_TRUE((*value)[0].style.has_array);
  EXPECT_TRUE((*value)[1].leaves_out_others);
}

TEST(RvizFile, HasAxesOfItsFixedFrame) {
  const std::string axes =
      "    - {Class: rviz/Axes, Enabled: true, Reference Frame: <Fixed Frame>}\n";
  const auto name_in = [&](const std::string& frame) {
    return ReadText(WithDisplays(axes, "  Global Options: {Fixed Frame: " + frame + "}\n"))
        .topics.at(0)
        .name;
  };
  EXPECT_EQ(name_in("odom"), "tf:odom");
  EXPECT_EQ(name_in("map"), "tf:") << "RViz begins with it, and it need not be there";
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

TEST(RvizFile, FollowsNothingInAViewThatRvizCannotLoad) {
  EXPECT_EQ(ReadText(WithView("      {Target Frame: base_link}\n")).target.frame, "");
  EXPECT_EQ(ReadText(WithView("      {Class: rviz/Orbit, Target Frame: base_link}\n")).target.frame,
            "base_link");
}

// A pixel of a view from above is 0.5 mm, or 1 m.
TEST(RvizFile, HasTheScaleOfAnyViewFromAbove) {
  for (const double scale : {2000.0, 1.0}) {
    const render::Camera camera =
        CameraOf("      {Class: rviz/TopDownOrtho, Scale: " + std::to_string(scale) + "}\n");
    EXPECT_NEAR(camera.ortho_height_m, kPictureHeight / scale, 1e-3 * kPictureHeight / scale);
    EXPECT_GT(camera.position.z(), 1);
  }
  for (const char* scale : {"0.02", "0", "no number"}) {  // the camera would be too far away
    const RvizPicture far =
        ReadText(WithView(std::string("      {Class: rviz/TopDownOrtho, Scale: ") + scale + "}\n"));
    EXPECT_EQ(SettingsOf(far).count("camera"), 0U) << scale;
    EXPECT_THAT(far.remarks, Contains(HasSubstr("more than 1000 m away"))) << scale;
  }
  const render::Camera turned = CameraOf("      {Class: rviz/TopDownOrtho, Scale: -10}\n");
  EXPECT_NEAR(turned.up.y(), -1, 1e-9);
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

TEST(RvizFile, HasGridsAsTopics) {
  const auto grid_of = [](const std::string& properties) {
    return TopicsOf("Class: rviz/Grid" + properties).at(0);
  };
  EXPECT_EQ(grid_of("").name, "grid:");
  EXPECT_EQ(grid_of("").style, "") << "ours is RViz's usual one";
  EXPECT_TRUE(grid_of("").is_floor);
  EXPECT_FALSE(grid_of("").floor_differs);
  EXPECT_TRUE(grid_of(", Plane Cell Count: 20").is_floor);
  EXPECT_TRUE(grid_of(", Offset: {X: 0, Y: 0, Z: -0.9}").floor_differs);
  EXPECT_TRUE(grid_of(", Reference Frame: table").floor_differs);
  EXPECT_FALSE(grid_of(", Plane: YZ").is_floor);
  EXPECT_EQ(grid_of(", Reference Frame: /table").name, "grid:table");
  EXPECT_EQ(grid_of(", Reference Frame: /table").style, "(missing=origin)");
  EXPECT_EQ(grid_of(", Plane Cell Count: 3.7").style, "(cells=1)") << "no whole number is 0";
  EXPECT_EQ(grid_of(", Alpha: 1, Alpha: 0.25").style, "(alpha=0.25)") << "the last one counts";
  EXPECT_EQ(grid_of(", Plane: XZ, Cell Size: 0.5, Plane Cell Count: 20, Normal Cell Count: 2, "
                    "Color: 255; 0; 0, Alpha: 1, Offset: {X: 1, Y: 0, Z: -0.9}, "
                    "Line Style: {Value: Billboards, Line Width: 0.05}")
                .style,
            "(size=0.5,cells=20,layers=2,plane=xz,at=1|0|-0.9,color=#ff0000,alpha=1,width=0.05)");
  const RvizPicture fixed = ReadText(WithDisplays("    - {Class: rviz/Grid, Enabled: true}\n",
                                                  "  Global Options: {Fixed Frame: odom}\n"));
  EXPECT_EQ(fixed.topics.at(0).name + fixed.topics.at(0).style, "grid:odom(missing=scene)");
}

TEST(ShownTopics, HaveGrids) {
  ShownTopicsValue value;
  value.Parse("grid:,grid:table(size=0.5,cells=20,layers=2,plane=yz,at=1|-2|0.5,missing=scene)");
  ASSERT_EQ(value->size(), 2u);
  EXPECT_TRUE((*value)[0].is_grid && (*value)[0].is_frame);
  EXPECT_EQ((*value)[0].style.grid.cells, 10);
  const ShownTopic& second = (*value)[1];
  EXPECT_EQ(second.name, "table");
  EXPECT_EQ(second.style.size_m, 0.5);
  EXPECT_EQ(second.style.grid.cells, 20);
  EXPECT_EQ(second.style.grid.layers, 2);
  EXPECT_EQ(second.style.grid.plane, GridStyle::Plane::kYz);
  EXPECT_THAT(second.style.grid.offset, ElementsAre(1, -2, 0.5));
  EXPECT_TRUE(second.style.stands_in_scene && !second.style.is_told_missing);
  for (const char* wrong :
       {"grid:*", "grid:a b", "grid:(cells=0)", "grid:(cells=1001)", "grid:(cells=2.5)",
        "grid:(layers=21)", "grid:(cells=200,layers=1)", "grid:(plane=zx)", "grid:(at=1|2)",
        "grid:(at=1|2|3|4)", "grid:(at=1|2|x)", "grid:(at=1e9|0|0)", "grid:(missing=world)"}) {
    EXPECT_THROW(ShownTopicsValue().Parse(wrong), options::BadValue) << wrong;
  }
}

TEST(RvizFile, HasHowManyMessagesAreShown) {
  const RvizPicture picture = ReadText(R"(
Visualization Manager:
  Displays:
    - {Class: rviz/Odometry, Enabled: true, Topic: /a, Keep: 0, Position Tolerance: 0.5, Angle Tolerance: 0}
    - {Class: rviz/PointCloud2, Enabled: true, Topic: /b, Decay Time: 5}
    - {Class: rviz/WrenchStamped, Enabled: true, Topic: /c, History Length: 20, Hide Small Values: true}
    - {Class: rviz/Path, Enabled: true, Topic: /d, Buffer Length: 100000}
    - {Class: rviz/LaserScan, Enabled: true, Topic: /e, Decay Time: 1e9}
)");
  std::vector<ShownTopic> topics;
  for (const RvizPicture::Topic& topic : picture.topics) {
    ShownTopicsValue value;
    value.Parse(topic.name + topic.style);
    topics.push_back(value->front());
  }
  ASSERT_EQ(topics.size(), 5u);
  EXPECT_EQ(topics[0].style.earlier.keep, 1000u) << "all";
  EXPECT_EQ(topics[0].style.earlier.step_m, 0.5);
  EXPECT_EQ(topics[0].style.earlier.turn_rad, 0);
  EXPECT_EQ(topics[1].style.earlier.decay_secs, 5);
  EXPECT_EQ(topics[2].style.earlier.keep, 20u);
  EXPECT_EQ(topics[3].style.earlier.keep, 1000u);
  EXPECT_EQ(topics[4].style.earlier.decay_secs, 600);
}

TEST(RvizFile, HasAxesOfFrames) {
  const RvizPicture picture = ReadText(R"(
Visualization Manager:
  Global Options: {Fixed Frame: /odom}
  Displays:
    - {Class: rviz/Axes, Enabled: true, Length: 2, Radius: 0.5, Reference Frame: base_link, Alpha: 0.5}
    - {Class: rviz/Axes, Enabled: true, Reference Frame: <Fixed Frame>}
    - {Class: rviz/Axes, Enabled: true, Reference Frame: odom, Length: 100}
    - {Class: rviz/Axes, Enabled: true, Name: Bad, Reference Frame: a b}
)");
  std::vector<std::string> items;
  for (const RvizPicture::Topic& topic : picture.topics) items.push_back(topic.name + topic.style);
  EXPECT_THAT(items, ElementsAre("tf:base_link(size=2,width=0.5,alpha=0.5)",
                                 "tf:odom(size=1,width=0.1,missing=scene)",
                                 "tf:odom(size=10,width=0.1,missing=scene)"));
  EXPECT_THAT(picture.remarks,
              Contains(HasSubstr("'Bad' is not drawn: 'a b' is no name of a frame")));
  ShownTopicsValue value;
  value.Parse(items[0] + "," + items[1] + ",/walls");
  EXPECT_TRUE((*value)[0].is_frame);
  EXPECT_EQ((*value)[0].name, "base_link");
  EXPECT_EQ((*value)[0].style.width_m, 0.5);
  EXPECT_EQ((*value)[1].name, "odom");
  EXPECT_FALSE((*value)[2].is_frame);
}

TEST(RvizFile, HasAllFramesOfTf) {
  const RvizPicture picture = ReadText(R"(
Visualization Manager:
  Displays:
    - {Class: rviz/TF, Enabled: true, Name: TF, Show Names: false, Show Arrows: true, Marker Scale: 0.5,
       Marker Alpha: 0.5, Frame Timeout: 5,
       Frames: {All Enabled: false, left: {Value: false}, right: {Value: true}, a-b: {Value: false}, odom: {Value: false}}}
)");
  ASSERT_EQ(picture.topics.size(), 1u);
  EXPECT_TRUE(picture.topics[0].is_every_frame);
  const std::string item = picture.topics[0].name + picture.topics[0].style;
  EXPECT_EQ(
      item,
      "tf:*(color=#ffffff,size=0.1,text=0.05,alpha=0.5,names=off,timeout=5,without=left|odom)");
  EXPECT_THAT(picture.remarks, Contains(HasSubstr("the frame 'a-b' is not left out")));
  ShownTopicsValue value;
  value.Parse(item + ",/walls");
  ASSERT_TRUE((*value)[0].is_every_frame());
  const FramesStyle& frames = (*value)[0].style.frames;
  EXPECT_FALSE(frames.has_names);
  EXPECT_TRUE(frames.has_arrows);
  EXPECT_EQ(frames.timeout_secs, 5);
  EXPECT_THAT(frames.hidden, ElementsAre("left", "odom"));
  EXPECT_FALSE((*value)[1].is_every_frame());
}

TEST(RvizFile, RefusesStylesThatSayNothing) {
  for (const char* bad : {"/a(",
                          "/a()b",
                          "/a(color=red)",
                          "/a(size=0)",
                          "/a(size=11)",
                          "/a(pixels=0.5)",
                          "/a(pixels=101)",
                          "/a(pixels=few)",
                          "/a(alpha=2)",
                          "/a(shape=cube)",
                          "/a(scheme=raw)",
                          "/a(updates=yes)",
                          "/a(points=0)",
                          "/a(keep=0)",
                          "/a(keep=1001)",
                          "/a(keep=2.5)",
                          "/a(decay=-1)",
                          "/a(decay=601)",
                          "/a(step=far)",
                          "/a(points=100001)",
                          "/a(points=1.5)",
                          "/a(by=)",
                          "/a(by=a/b)",
                          "/a(from=low)",
                          "/a(to=1e13)",
                          "/a(low=blue)",
                          "/a(force=-1)",
                          "/a(force=2000)",
                          "/a(width=0)",
                          "tf:/odom",
                          "/a(covariance=-1)",
                          "/a(covariance_alpha=2)",
                          "/a(covariance_color=red)",
                          "/a(without=)",
                          "/a(without=a||b)",
                          "/a(turn_covariance=-1)",
                          "/a(turn_covariance_alpha=2)",
                          "/a(turn_covariance_color=red)",
                          "/a(turn_covariance_offset=0)",
                          "/a(turn_covariances=1)",
                          "/a(pose_size=0)",
                          "/a(pose_color=red)",
                          "/a(handles=no)",
                          "/a(linear=far)",
                          "tf:**",
                          "tf:*,tf:*",
                          "tf:*(names=no)",
                          "tf:*(timeout=0)",
                          "tf:*(without=a b)",
                          "tf:*(without=)",
                          "tf:a b",
                          "/a(torque_color=5)",
                          "/a(small=no)",
                          "/a(rainbow=no)",
                          "/a(height=1)",
                          "/a(color)",
                          "(size=1)",
                          "/a b"}) {
    ShownTopicsValue value;
    EXPECT_THROW(value.Parse(bad), options::BadValue) << bad;
  }
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

TEST(RvizOption, LeavesOutWhatHasNoEffect) {
  const kinescope::testing::TempFolder folder;
  const std::string file = folder / "lab.rviz";
  std::ofstream(file) << WithView("      {Class: rviz/Orbit}\n");
  options::FilePath rviz;
  rviz.Parse(file);
  for (const bool has_pictures : {true, false}) {
    CamerasValue camera(1);
    options::OptionList list;
    list("camera", camera, "where the camera stands");
    list.HasNoEffect("camera", "with --pictures=off", [&] { return !has_pictures; });
    ApplyRviz(rviz, kPictureHeight, list);
    EXPECT_EQ(list.Find("camera")->channel == options::Channel::kFile, has_pictures);
  }
}

TEST(RvizOption, NamesAFixedFrameThatIsNotThatOfTheScene) {
  const kinescope::testing::TempFolder folder;
  const std::string file = folder / "lab.rviz";
  options::FilePath rviz;
  rviz.Parse(file);
  const auto said_for = [&](const std::string& fixed, const std::string& reference) {
    std::ofstream(file) << "Visualization Manager:\n  Global Options: {Fixed Frame: " << fixed
                        << "}\n";
    options::Text frame("world");
    frame.Parse(reference);
    options::OptionList list;
    if (!reference.empty()) list("reference_frame", frame, "the frame of the scene");
    const kinescope::testing::CapturedLog log;
    ApplyRviz(rviz, kPictureHeight, list);
    return log.text();
  };
  EXPECT_THAT(said_for("/ground", "world"),
              HasSubstr("lab.rviz:2: Fixed Frame 'ground': the scene is drawn in 'world'; if the "
                        "people are in that frame, give --reference_frame"));
  EXPECT_THAT(said_for("odom", ""), HasSubstr("drawn in 'world', the frame of its source"));
  EXPECT_THAT(said_for("ground", "ground"), Not(HasSubstr("Fixed Frame")));
  EXPECT_THAT(said_for("map", "world"), Not(HasSubstr("Fixed Frame")));
}

TEST(RvizOption, LetsTheCameraGoWithTheFrameOfTheViewWhereThereAreFrames) {
  const kinescope::testing::TempFolder folder;
  const std::string file = folder / "lab.rviz";
  options::FilePath rviz;
  rviz.Parse(file);
  struct Applied {
    std::string camera_tf, said;
  };
  const auto apply = [&](const std::string& fixed, const std::string& view,
                         const std::string& ros = "on", bool has_camera = false) {
    std::ofstream(file) << "Visualization Manager:\n  Global Options: {Fixed Frame: " << fixed
                        << "}\n  Views: {Current: {" << view << "}}\n";
    options::Text frame("world"), graph(ros);
    CamerasValue camera(1);
    CameraBaseValue base;
    options::OptionList list;
    list("reference_frame", frame, "the frame of the scene");
    list("ros", graph, "whether there is a graph");
    list("camera", camera, "where the camera stands");
    list("camera_tf", base, "what it goes with");
    if (has_camera)
      list.Set(*list.Find("camera"), "camera", {"front", ""}, options::Channel::kCommandLine);
    const kinescope::testing::CapturedLog log;
    ApplyRviz(rviz, kPictureHeight, list);
    return Applied{base.ToText(), log.text()};
  };
  const Applied cart = apply("world", "Class: rviz/ThirdPersonFollower, Target Frame: cart");
  EXPECT_EQ(cart.camera_tf, "cart:heading");
  EXPECT_THAT(cart.said, Not(HasSubstr("Frame")));
  EXPECT_EQ(apply("world", "Class: rviz/Orbit, Target Frame: world").camera_tf, "");
  const Applied odom = apply("odom", "Class: rviz/Orbit");
  EXPECT_EQ(odom.camera_tf, "odom:pose");
  EXPECT_THAT(odom.said, HasSubstr("lab.rviz:2: Fixed Frame 'odom': the camera stands in it, the "
                                   "floor is that of 'world'"));
  const Applied both = apply("odom", "Class: rviz/Orbit, Target Frame: cart");
  EXPECT_EQ(both.camera_tf, "cart");
  EXPECT_THAT(both.said, HasSubstr("Fixed Frame 'odom': the scene is drawn in 'world'"));
  EXPECT_EQ(apply("odom", "Class: rviz/Orbit", "on", /*has_camera=*/true).camera_tf, "");
  const Applied bare = apply("world", "Class: rviz/Orbit, Target Frame: cart", "off");
  EXPECT_EQ(bare.camera_tf, "");
  EXPECT_THAT(bare.said, HasSubstr("lab.rviz:3: the view's Target Frame 'cart' is not followed: "
                                   "the source has no frames but those of people (a bag has, and "
                                   "serve with ROS)"));
  EXPECT_EQ(apply("world", "Class: rviz/Orbit, Target Frame: skeleton_pelvis", "off").camera_tf,
            "skeleton_pelvis");
  EXPECT_THAT(apply("world", "Class: rviz/Orbit, Target Frame: \"a b\"").said,
              HasSubstr("'a b' is not followed: it is no name of a frame"));
}

TEST(RvizFile, ReadsWhatOthersSavedAsRvizItselfDoes) {
  KINESCOPE_NEEDS_SHARED_DATA("rviz");
  const fs::path folder = SharedData("rviz");
  int read = 0;
  for (const auto& entry : fs::directory_iterator(folder / "resaved-1.14.19")) {
    const fs::path original = folder / entry.path().filename();
    if (!fs::exists(original)) continue;
    auto ours = SettingsOf(ReadRvizFile(original, kPictureHeight));
    auto resaved = SettingsOf(ReadRvizFile(entry.path(), kPictureHeight));
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
