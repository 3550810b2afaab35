#include "server/picture/view_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core/system/errors.h"
#include "server/picture/render_planner.h"
#include "tests/render/test_scene.h"
#include "tests/server/options_testing.h"
#include "tests/temp_folder.h"
#include "tests/urdf/rig/rig_samples.h"

namespace kinescope::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

render::OverlayParts Overlays(const std::string& text) {
  return *testing::With<ViewOptions>({{"overlay", text}}).overlay;
}

ViewGrid Grid(const std::string& text) {
  return *testing::With<ViewOptions>({{"views", text}}).views;
}

std::string Error(const std::string& name, const std::string& text) {
  return testing::ErrorOfSetting<ViewOptions>(name, text);
}

TEST(ViewOptions, AcceptAListOfOverlaysOrChangesOfTheDefault) {
  EXPECT_TRUE(Overlays("").legend);
  EXPECT_FALSE(Overlays("").frame_code);
  EXPECT_FALSE(Overlays("time,scale").legend);
  EXPECT_TRUE(Overlays("time,scale").scale);
  EXPECT_TRUE(Overlays("+frame_code,-legend").time);
  EXPECT_TRUE(Overlays("+frame_code,-legend").frame_code);
  EXPECT_FALSE(Overlays("+frame_code,-legend").legend);
  EXPECT_THAT(Error("overlay", "time,-legend"), HasSubstr("either"));
  EXPECT_THAT(Error("overlay", "+legnd"), HasSubstr("unknown 'legnd'"));
  EXPECT_THAT(Error("overlay", "+legnd"), HasSubstr("nearest: legend"));
  EXPECT_THAT(Error("overlay", "time,"), HasSubstr("unknown ''"));
}

TEST(ViewOptions, AcceptRowsOfCamerasAsViews) {
  EXPECT_TRUE(Grid("").cameras.empty());
  EXPECT_EQ(Grid("front,left,top/camera").columns, 3);
  EXPECT_THAT(Grid("2x2").cameras, ElementsAre("front", "right", "top", "three_quarter"));
  EXPECT_THAT(Error("views", "front/left,top"), HasSubstr("row 2 has 2"));
  EXPECT_THAT(Error("views", "front,top//left,right"), HasSubstr("row 2 has 0"));
  EXPECT_THAT(Error("views", "front,nowhere"), HasSubstr("front, back"));
}

TEST(ViewOptions, TakeARiggedPersonOfTheUsersAsFigure) {
  const testing::TempFolder folder;
  const std::string file = folder / "person.glb";
  std::ofstream(file, std::ios::binary) << testing::RigGlb();
  const auto options = testing::With<ViewOptions>({{"figure", "skin:" + file}});
  EXPECT_EQ(options.figure.ToText(), "skin:" + file);
  EXPECT_THAT(options.figure.Files(), ElementsAre(file));
  const render::PictureSpec spec = ToPictureSpec(options);
  ASSERT_TRUE(spec.look.figure.own_skin);
  EXPECT_EQ(spec.look.figure, ToPictureSpec(ViewOptions(options)).look.figure) << "read once";
  EXPECT_FALSE(
      ToPictureSpec(testing::With<ViewOptions>({{"figure", "skin"}})).look.figure.own_skin);
  EXPECT_THAT(Error("figure", "skin:"), HasSubstr("expected skin, skin:FILE.glb or urdf"));
  EXPECT_THAT(Error("figure", "sikn"), HasSubstr("nearest: skin"));
  std::ofstream(file, std::ios::binary) << "no GLB";
  for (const auto& [name, why] :
       {std::pair(file, "not a GLB"), std::pair((folder / "none.glb").string(), "no such file")}) {
    const auto wrong = testing::With<ViewOptions>({{"figure", "skin:" + name}});
    try {
      ToPictureSpec(wrong);
      FAIL() << name;
    } catch (const UsageError& error) {
      EXPECT_THAT(error.what(), HasSubstr("--figure=skin:" + name + ": " + why));
    }
  }
}

TEST(ViewOptions, AcceptRowsOfTimesAsViews) {
  const ViewGrid grid = Grid("time:0,0.5/1,0");
  EXPECT_THAT(grid.times, ElementsAre(0, 0.5, 1, 0));
  EXPECT_THAT(grid.TimesInOrder(), ElementsAre(0, 0.5, 1));
  EXPECT_EQ(grid.columns, 2);
  EXPECT_TRUE(grid.cameras.empty());
  for (const char* text : {"time:", "time:0,", "time:nan", "time:0,-1", "time:1e9", "time:0/x",
                           "time:0//1", "time:front"}) {
    EXPECT_THAT(Error("views", text), HasSubstr("is not a time; expected 0 to 864000 s")) << text;
  }
  EXPECT_THAT(Error("views", "time:0/1,2"), HasSubstr("row 2 has 2 times; expected 1"));
  std::string many = "time:0";
  for (int i = 1; i < 17; ++i) many += "," + std::to_string(i);
  EXPECT_THAT(Error("views", many), HasSubstr("has 17 views; expected at most 16"));
}

TEST(ViewOptions, RejectWhatSeveralMomentsHaveNotInCommon) {
  const auto error = [](const char* name, const char* text) -> std::string {
    try {
      ToPictureSpec(testing::With<ViewOptions>({{"views", "time:0,1"}, {name, text}}));
    } catch (const UsageError& refused) {
      return refused.what();
    }
    return "";
  };
  EXPECT_THAT(error("plot", "l5_s1"), HasSubstr("--plot=l5_s1"));
  EXPECT_THAT(error("overlay", "frame_code"), HasSubstr("frame code"));
  EXPECT_EQ(error("legend", "below"), "");
}

TEST(ViewOptions, PlaceTheLegend) {
  const auto spec = [](const char* place) {
    return ToPictureSpec(testing::With<ViewOptions>({{"legend", place}}));
  };
  EXPECT_FALSE(spec("off").parts.legend);
  EXPECT_EQ(spec("below").legend, render::LegendPlace::kBelow);
  EXPECT_EQ(spec("outside").legend, render::LegendPlace::kOutside);
  EXPECT_EQ(spec("inside").legend, render::LegendPlace::kInside);
  EXPECT_THAT(Error("legend", "belwo"),
              HasSubstr("expected inside, outside, below or off; nearest: below"));
}

TEST(ViewOptions, RejectAWidthInPrintAtWhichNoTextFits) {
  const auto narrow = testing::With<ViewOptions>({{"width_mm", "20"}});
  EXPECT_THROW(ToPictureSpec(narrow), UsageError);
  const auto bare = testing::With<ViewOptions>({{"width_mm", "20"}, {"no_overlays", "true"}});
  EXPECT_NO_THROW(ToPictureSpec(bare));
}

TEST(ViewOptions, AcceptOnlyJointsWithALoadForPlots) {
  EXPECT_THAT(*testing::With<ViewOptions>({{"plot", "l5_s1,right_elbow"}}).plot,
              ElementsAre(urdf::jL5S1, urdf::jRightElbow));
  EXPECT_THAT(Error("plot", "right_toe"), HasSubstr("right_knee"));
  const auto shown = testing::With<ViewOptions>({{"plot", "l5_s1"}, {"overlay", "title"}});
  EXPECT_TRUE(ToPictureSpec(shown).parts.plot);
  const auto hidden = testing::With<ViewOptions>({{"plot", "l5_s1"}, {"overlay", "-plot"}});
  EXPECT_FALSE(ToPictureSpec(hidden).parts.plot);
}

TEST(ViewOptions, RejectUnknownNamesWithTheNearestOne) {
  EXPECT_THAT(Error("theme", "drak"), HasSubstr("expected light or dark; nearest: dark"));
  EXPECT_THAT(Error("background", "#12345"), HasSubstr("#RRGGBB"));
  EXPECT_THAT(Error("floor", "maybe"), HasSubstr("--floor=maybe: expected on or off"));
  EXPECT_THAT(Error("show", "link_frames,wings"), HasSubstr("unknown 'wings'"));
  EXPECT_THAT(Error("hide", "bdy"), HasSubstr("nearest: body"));
  EXPECT_THAT(Error("trail", "tail"), HasSubstr("right_hand"));
  for (const char* secs : {"0", "-1", "60.01", "nan"}) {
    EXPECT_THAT(Error("trail_secs", secs), HasSubstr("at most 60 s")) << secs;
  }
  for (const char* bad : {"demo:lift", "demo:lift@soon", "@3", "nose"}) {
    EXPECT_THAT(Error("ghost", bad), HasSubstr("SOURCE@SECS")) << bad;
  }
  EXPECT_THAT(Error("ghost_opacity", "2"), HasSubstr("from 0 to 1"));
  for (const char* bad : {"a.urdf@1", "a.urdf@1,2,3,4", "a.urdf@1,y", "a.urdf@1001,0", "@1,2",
                          "@tf", "a.urdf@tf:", "a.urdf@tf:/lab", "a.urdf@tf:a b", "ros:", "ros:a b",
                          "ros:/arm@1,2", "a.urdf(alpha=2)", "a.urdf(alpha=)", "(alpha=0.5)"}) {
    EXPECT_THAT(Error("robot", bad), HasSubstr("FILE.urdf@X,Y")) << bad;
  }
  EXPECT_THAT(Error("camera", "front,top"), HasSubstr("at most 1 camera"));
  EXPECT_THAT(Error("camera", "fron"), HasSubstr("nearest: front"));
}

TEST(ViewOptions, TellRobotsThatStandFromThoseThatTfMoves) {
  ViewOptions options;
  options.robot.ParseAll({"a.urdf", "b@tf.urdf@1,2", "c.urdf@tf", "d.urdf@tf:lab/arm",
                          "ros:/arm/robot_description@tf:arm", "ros:robot_description",
                          "e(1).urdf@tf:arm(alpha=0.25)"});
  const std::vector<RobotPlace>& robots = *options.robot;
  ASSERT_EQ(robots.size(), 7u);
  EXPECT_FALSE(robots[0].tf_prefix || robots[1].tf_prefix);
  EXPECT_EQ(robots[1].file, "b@tf.urdf");
  EXPECT_EQ(robots[2].file, "c.urdf");
  EXPECT_EQ(robots[2].tf_prefix, "");
  EXPECT_EQ(robots[3].tf_prefix, "lab/arm");
  EXPECT_EQ(robots[4].file, "");
  EXPECT_EQ(robots[4].parameter, "/arm/robot_description");
  EXPECT_EQ(robots[4].tf_prefix, "arm");
  EXPECT_EQ(robots[5].tf_prefix, "");
  EXPECT_EQ(robots[5].opacity, 1);
  EXPECT_EQ(robots[6].file, "e(1).urdf");
  EXPECT_EQ(robots[6].tf_prefix, "arm");
  EXPECT_EQ(robots[6].opacity, 0.25);
  EXPECT_THAT(options.robot.WithoutMoving().ToTexts(), ElementsAre("a.urdf", "b@tf.urdf@1,2"));
  options.robot.SetFolder("/lab");
  EXPECT_THAT(options.robot.ToTexts(),
              ElementsAre("/lab/a.urdf", "/lab/b@tf.urdf@1,2", "/lab/c.urdf@tf",
                          "/lab/d.urdf@tf:lab/arm", "ros:/arm/robot_description@tf:arm",
                          "ros:robot_description", "/lab/e(1).urdf@tf:arm(alpha=0.25)"));
}

TEST(ViewOptions, ListTheFilesThatDetermineThePicture) {
  const kinescope::testing::TempFolder folder;
  std::ofstream(folder / "box.obj") << "mtllib box.mtl\n";
  std::ofstream(folder / "box.mtl") << "newmtl a\n";
  const std::string urdf = folder / "r.urdf", walk = folder / "walk.mvnx";
  std::ofstream(urdf) << "<robot name='r'><link name='a'><visual><geometry>"
                         "<mesh filename='box.obj'/></geometry></visual></link></robot>";
  std::ofstream(walk) << "x";
  const auto view = testing::With<ViewOptions>(
      {{"robot", urdf + "@1,0"}, {"ghost", walk + "@2"}, {"camera", folder / "keys.yaml"}});
  EXPECT_THAT(view.robot.Files(),
              ::testing::UnorderedElementsAre(urdf, folder / "box.obj", folder / "box.mtl"));
  EXPECT_THAT(view.ghost.Files(), ElementsAre(walk));
  EXPECT_THAT(view.camera.Files(), ElementsAre(folder / "keys.yaml"));
  EXPECT_THAT(ViewOptions().camera.Files(), ::testing::IsEmpty());
}

SceneState SceneWithLoad(double secs, double ratio) {
  SceneState state = kinescope::testing::SceneWith(kinescope::testing::Posture::kStanding);
  state.stamp_nanos = 1'000'000'000 + std::llround(1e9 * secs);
  kinescope::testing::LoadOf(state, urdf::jL5S1).shown_ratio = ratio;
  return state;
}

TEST(RenderPlanner, PlotsTheWholeClipAfterAFirstPassOrTheNewestSeconds) {
  const auto options = testing::With<ViewOptions>({{"plot", "l5_s1"}});
  RenderPlanner prescanned(options), growing(options);
  for (int k = 0; k <= 40; ++k) prescanned.Prescan(SceneWithLoad(0.5 * k, 0.01 * k));
  for (int k = 0; k <= 40; ++k) {
    const SceneState scene = SceneWithLoad(0.5 * k, 0.01 * k);
    const RenderRequest whole = prescanned.Next(scene), newest = growing.Next(scene);
    ASSERT_TRUE(whole.spec.load_curves && newest.spec.load_curves && whole.spec.parts.plot);
    EXPECT_NEAR(whole.spec.plot_secs, 0.5 * k, 1e-9);
    EXPECT_EQ(whole.spec.load_curves->curves.at(0).points.size(), 41u);
    EXPECT_NEAR(whole.spec.load_curves->to_secs, 20, 1e-9);
    const auto& points = newest.spec.load_curves->curves.at(0).points;
    EXPECT_EQ(points.size(), static_cast<std::size_t>(std::min(k, 20) + 1)) << "10 s";
    EXPECT_EQ(points.back().ratio, 0.01 * k);
    EXPECT_GE(points.front().secs, newest.spec.load_curves->from_secs - 1e-6);
  }
}

}  // namespace
}  // namespace kinescope::app
