#include "server/picture/rviz_topics.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "server/options/ros_names.h"
#include "tests/server/picture/rviz_fixture.h"

namespace kinescope::app {
namespace {

using kinescope::testing::ReadText;
using kinescope::testing::WithDisplays;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<RvizPicture::Topic> TopicsOf(const std::string& display) {
  return ReadText(WithDisplays("    - {Enabled: true, Name: A, " + display + "}\n")).topics;
}

std::string StyleOf(const std::string& display) { return TopicsOf(display).at(0).style; }

TEST(RvizTopics, HasTheTopicsOfDisplaysThatAreOn) {
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
  EXPECT_EQ(picture.topics[2].style, "(pixels=1)");
  EXPECT_THAT(picture.remarks, Contains(HasSubstr("'/scan;rm' is no name of a topic")));
  EXPECT_EQ(picture.topics[3].name, "/odom");
  EXPECT_THAT(picture.topics[3].style, HasSubstr(",keep=100,step=0.1,turn=0.1)"));
}

TEST(RvizTopics, HasColoursOpacityAndSizesOfDisplays) {
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
      ElementsAre("(color=#ff0010,alpha=0.5,size=0.1)", "(shape=axes,width=0.1,size=0.4)",
                  "(color=#19ff00,pixels=1)", "(shape=axes,pose_width=0.03,pose_size=0.3,size=0.2)",
                  "(color=#00ff80,shape=cubes,size=0.03)", "(pixels=5)", "(by=z)",
                  "(color=#010203,force=2.6,torque=2.6,width=0.5,torque_color=#cccc33)",
                  "(pixels=1,size=0.5)", "(shaft_width=0.05,head_width=0.1,head=8,size=10)",
                  "(color=#0000ff,alpha=0.5,shaft_width=0.05,head_width=0.1,head=0.25,size=0.75,"
                  "covariance=1,covariance_alpha=0.3,"
                  "covariance_"
                  "color=#cc33cc,turn_covariance=1,turn_covariance_alpha=0.5,turn_covariance_"
                  "offset=1,turn_covariance_color=#ffff7f,keep=1,step=0.1,turn=0.1)",
                  "(alpha=0.25,scheme=costmap,updates=on,behind=on)", "(scheme=raw,updates=on)",
                  "(color=#19ff00,pixels=1)", "(by=x,from=-1,to=2.5,axis=message)",
                  "(by=intensity,rainbow=inverted)",
                  "(by=ring,from=5,to=1000000000000,low=#0000ff,high=#ff0000)", "(by=_)", ""));
  for (const char* remark :
       {"Draw Behind: it is drawn behind other maps", "an arrow of 17 m is drawn with 10 m",
        "Channel Name 'my,ring' cannot be taken; its points are white",
        "Color Transformer 'MONO8' is not taken"}) {
    EXPECT_THAT(picture.remarks, Contains(HasSubstr(remark)));
  }
  ShownTopicsValue value;
  value.Parse(all);
  ASSERT_EQ(value->size(), 14u);
  EXPECT_TRUE((*value)[1].style.has_axes);
  EXPECT_EQ((*value)[11].style.map_colors, MapColors::kCostmap);
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
  EXPECT_TRUE((*value)[0].style.scale->is_in_message);
  EXPECT_TRUE((*value)[1].style.scale->is_inverted);
  EXPECT_EQ((*value)[2].style.scale->to, 1e12);
  EXPECT_EQ(((*value)[2].style.scale->low), (Rgb{0, 0, 1}));
}

TEST(RvizTopics, HasPointsInPixelsWithinLimits) {
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

TEST(RvizTopics, HasEffortsAsRings) {
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
TEST(RvizTopics, HasValuesAsSpheresAndTheArrowsOfWrenches) {
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
  EXPECT_EQ(picture.topics[2].style, "(force=0,torque=2.6,width=10,torque_color=#cccc33)");
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

TEST(RvizTopics, HasTwistsRangesCovariancesAndPicturesOfCameras) {
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

TEST(RvizTopics, HasTheSceneOverTheImagesOfCameras) {
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

TEST(RvizTopics, HasCloudsOfDepths) {
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

TEST(RvizTopics, HasInteractiveMarkersAndSolidArrows) {
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
  EXPECT_EQ(topics[2].style, "(shape=arrows,shaft_width=0.01,head_width=0.03,head=0.25,size=0.75)");
  EXPECT_EQ(topics[3].style,
            "(pixels=1,shape=arrows,shaft_width=0.1,head_width=0.3,head=0.3,pose_color=#ff0000,"
            "pose_size=0.4)");
  const auto without = topics_of("{Class: rviz/MoveCamera}, {Class: rviz/Interact}");
  EXPECT_EQ(without.at(1).style, "(handles=off)") << "Interact is not the active tool";
  ShownTopicsValue value;
  value.Parse("/a" + topics[3].style + ",/b" + without[1].style);
  EXPECT_TRUE((*value)[0].style.has_arrows);
  EXPECT_EQ((*value)[0].style.poses.size_m, 0.4);
  EXPECT_FALSE((*value)[1].style.has_handles);
}

TEST(RvizTopics, LeavesOutNamespacesOfMarkersOfOthers) {
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

// A property may be written with what is below it, or alone.
TEST(RvizTopics, TakesPropertiesInBothForms) {
  const auto style_of = [](const std::string& display) {
    return ReadText(WithDisplays("    - {Enabled: true, Topic: /a, " + display + "}\n"))
        .topics.at(0)
        .style;
  };
  const std::string axes = style_of(
      "Class: rviz/Odometry, Shape: {Value: Axes, Axes Length: 2}, Covariance: {Value: false}");
  EXPECT_THAT(axes, HasSubstr("shape=axes"));
  EXPECT_THAT(axes, HasSubstr("size=2"));
  EXPECT_THAT(axes, Not(HasSubstr("covariance")));
  EXPECT_THAT(style_of("Class: rviz/Odometry, Shape: Axes, Covariance: false"),
              AllOf(HasSubstr("shape=axes"), Not(HasSubstr("covariance"))));
  EXPECT_THAT(style_of("Class: rviz/PoseArray, Shape: {Value: Axes}"), HasSubstr("shape=axes"));
  EXPECT_THAT(style_of("Class: rviz/PoseArray, Shape: Axes"), HasSubstr("shape=axes"));
}

TEST(RvizTopics, TakesNamesOfColours) {
  const auto style_of = [](const std::string& color) {
    return ReadText(WithDisplays("    - {Class: rviz/Path, Enabled: true, Topic: /a, Color: " +
                                 color + "}\n"))
        .topics.at(0)
        .style;
  };
  EXPECT_EQ(style_of("red"), "(color=#ff0000,pixels=1)");
  EXPECT_EQ(style_of("Light Blue"), "(color=#add8e6,pixels=1)");
  EXPECT_EQ(style_of("yellowgreen"), "(color=#9acd32,pixels=1)") << "the last of all";
  EXPECT_EQ(style_of("aliceblue"), "(color=#f0f8ff,pixels=1)");
  EXPECT_EQ(style_of("reddish"), "(pixels=1)") << "RViz's own is ours";
}

TEST(RvizTopics, NamesWhatIsDrawnOtherwise) {
  const auto remarks_of = [](const std::string& display) {
    return ReadText(WithDisplays("    - {Enabled: true, Name: A, " + display + "}\n")).remarks;
  };
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"Class: rviz/Grid, Offset: {X: 0, Y: 0, Z: 1e9}", "its Offset is too far"},
      {"Class: rviz/Grid, Plane Cell Count: 4000, Alpha: 1", "Plane Cell Count 4000 is taken"},
      {"Class: rviz/Grid, Color: 1 2 3",
       "Color '1 2 3' is no r; g; b, #rrggbb or name of a colour; RViz's own is taken"},
      {"Class: rviz/Path, Topic: /a, Color: [255, 0, 0]", "Color that is no text is no r; g; b"},
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
      {"Class: rviz/Map, Topic: /a, Draw Behind: 1", "Draw Behind: it is drawn behind other maps"},
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

// What RViz 1.14 draws of a file that an older one has saved.
TEST(RvizTopics, HasDefaultsOfRvizForWhatAnOldFileDoesNotSay) {
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

TEST(RvizTopics, HasMarkersOfTheArrayBesideATopicOfSingleOnes) {
  EXPECT_EQ(StyleOf("Class: rviz/Marker, Marker Topic: /m, Namespaces: {a: false}"),
            "(array=on,without=a)");
  EXPECT_EQ(StyleOf("Class: rviz/MarkerArray, Marker Topic: /m"), "");
  EXPECT_EQ(StyleOf("Class: rviz/MarkerArray, Marker Topic: /m, Namespaces: {\"a;b\": false}"), "");
}

TEST(RvizTopics, DoesNotUseTheAlphaOfLines) {
  for (const char* const kind : {"Path", "Polygon", "PoseArray"}) {
    EXPECT_EQ(StyleOf("Class: rviz/" + std::string(kind) + ", Topic: /a, Alpha: 0"), "(pixels=1)")
        << kind;
  }
  EXPECT_EQ(StyleOf("Class: rviz/PoseArray, Topic: /a, Alpha: 0.5, Shape: Axes"),
            "(alpha=0.5,shape=axes,width=0.01)");
}

TEST(RvizTopics, HasThePartsOfArrows) {
  EXPECT_EQ(StyleOf("Class: rviz/Pose, Topic: /a, Shaft Length: 2, Shaft Radius: 0.1"),
            "(shaft_width=0.1,head_width=0.1,head=0.3,size=2.3)");
  EXPECT_EQ(StyleOf("Class: rviz/PoseArray, Topic: /a, Shape: Arrow (3D), Shaft Length: 1, "
                    "Head Length: 0.07, Head Radius: 0.02"),
            "(shape=arrows,shaft_width=0.01,head_width=0.02,head=0.07,size=1.07)");
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

TEST(RvizTopics, HasAxesOfItsFixedFrame) {
  const std::string axes =
      "    - {Class: rviz/Axes, Enabled: true, Reference Frame: <Fixed Frame>}\n";
  const auto name_in = [&](const std::string& frame) {
    return ReadText(WithDisplays(axes, "  Global Options: {Fixed Frame: " + frame + "}\n"))
        .topics.at(0)
        .name;
  };
  EXPECT_EQ(name_in("odom"), "tf:odom");
  EXPECT_EQ(name_in("map"), "tf:map");
}

TEST(RvizTopics, HasGridsAsTopics) {
  const auto grid_of = [](const std::string& properties) {
    return TopicsOf("Class: rviz/Grid" + properties).at(0);
  };
  EXPECT_EQ(grid_of("").name, "grid:map");
  EXPECT_EQ(grid_of("").style, "(missing=scene)") << "else ours is RViz's usual one";
  EXPECT_TRUE(grid_of("").is_floor);
  EXPECT_FALSE(grid_of("").floor_differs);
  EXPECT_TRUE(grid_of(", Plane Cell Count: 20").is_floor);
  EXPECT_TRUE(grid_of(", Offset: {X: 0, Y: 0, Z: -0.9}").floor_differs);
  EXPECT_TRUE(grid_of(", Reference Frame: table").floor_differs);
  EXPECT_FALSE(grid_of(", Plane: YZ").is_floor);
  EXPECT_EQ(grid_of(", Reference Frame: /table").name, "grid:table");
  EXPECT_EQ(grid_of(", Reference Frame: /table").style, "(missing=origin)");
  EXPECT_EQ(grid_of(", Plane Cell Count: 3.7").style, "(cells=1,missing=scene)")
      << "no whole number is 0";
  EXPECT_EQ(grid_of(", Alpha: 1, Alpha: 0.25").style, "(alpha=0.25,missing=scene)")
      << "the last one counts";
  EXPECT_EQ(grid_of(", Plane: XZ, Cell Size: 0.5, Plane Cell Count: 20, Normal Cell Count: 2, "
                    "Color: 255; 0; 0, Alpha: 1, Offset: {X: 1, Y: 0, Z: -0.9}, "
                    "Line Style: {Value: Billboards, Line Width: 0.05}")
                .style,
            "(size=0.5,cells=20,layers=2,plane=xz,at=1|0|-0.9,color=#ff0000,alpha=1,width=0.05,"
            "missing=scene)");
  const RvizPicture fixed = ReadText(WithDisplays("    - {Class: rviz/Grid, Enabled: true}\n",
                                                  "  Global Options: {Fixed Frame: odom}\n"));
  EXPECT_EQ(fixed.topics.at(0).name + fixed.topics.at(0).style, "grid:odom(missing=scene)");
}

TEST(RvizTopics, HasHowManyMessagesAreShown) {
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

TEST(RvizTopics, HasAxesOfFrames) {
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

TEST(RvizTopics, HasAllFramesOfTf) {
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

}  // namespace
}  // namespace kinescope::app
