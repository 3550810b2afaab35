#include "server/picture/rviz_option.h"

#include <gmock/gmock.h>

#include <fstream>
#include <string>

#include "server/picture/camera_options.h"
#include "tests/captured_log.h"
#include "tests/server/picture/rviz_fixture.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

using kinescope::testing::kRvizHeight;
using kinescope::testing::WithView;
using ::testing::HasSubstr;

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
    ApplyRviz(rviz, kRvizHeight, list);
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
    ApplyRviz(rviz, kRvizHeight, list);
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
    ApplyRviz(rviz, kRvizHeight, list);
    return Applied{base.ToText(), log.text()};
  };
  const Applied cart = apply("world", "Class: rviz/ThirdPersonFollower, Target Frame: cart");
  EXPECT_EQ(cart.camera_tf, "cart:heading");
  EXPECT_THAT(cart.said, Not(HasSubstr("Frame")));
  EXPECT_EQ(apply("world", "Class: rviz/Orbit, Target Frame: world").camera_tf, "");
  const Applied odom = apply("odom", "Class: rviz/Orbit");
  EXPECT_EQ(odom.camera_tf, "odom:pose");
  EXPECT_THAT(odom.said,
              HasSubstr("lab.rviz:2: Fixed Frame 'odom': the camera stands in it; the "
                        "floor, and what is kept of earlier messages, stand in 'world'"));
  const Applied both = apply("odom", "Class: rviz/Orbit, Target Frame: cart");
  EXPECT_EQ(both.camera_tf, "cart:axes=odom");
  EXPECT_THAT(both.said, HasSubstr("Fixed Frame 'odom': the camera stands in it"));
  EXPECT_EQ(apply("map", "Class: rviz/Orbit, Target Frame: cart").camera_tf, "cart:axes=map");
  EXPECT_EQ(apply("odom", "Class: rviz/ThirdPersonFollower, Target Frame: cart").camera_tf,
            "cart:heading");
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

}  // namespace
}  // namespace kinescope::app
