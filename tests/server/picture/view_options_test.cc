#include "server/picture/view_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/errors.h"
#include "server/picture/shots.h"
#include "tests/render/test_scene.h"

namespace kinescope::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

template <class Function>
std::string Complaint(Function&& function) {
  try {
    function();
    return "";
  } catch (const UsageError& error) {
    return error.what();
  }
}

TEST(ViewOptions, OverlaysAreAListOrChangesOfTheUsualOnes) {
  EXPECT_TRUE(ToOverlayParts("").legend);
  EXPECT_FALSE(ToOverlayParts("").strip);
  EXPECT_FALSE(ToOverlayParts("time,scale").legend);
  EXPECT_TRUE(ToOverlayParts("time,scale").scale);
  EXPECT_TRUE(ToOverlayParts("+strip,-legend").time);
  EXPECT_TRUE(ToOverlayParts("+strip,-legend").strip);
  EXPECT_FALSE(ToOverlayParts("+strip,-legend").legend);
  EXPECT_THAT(Complaint([] { ToOverlayParts("time,-legend"); }), HasSubstr("either"));
  EXPECT_THAT(Complaint([] { ToOverlayParts("+clock"); }), HasSubstr("'clock' is not known"));
  EXPECT_THAT(Complaint([] { ToOverlayParts("time,"); }), HasSubstr("'' is not known"));
}

TEST(ViewOptions, ViewsAreRowsOfCameras) {
  EXPECT_TRUE(ToViewGrid("").cameras.empty());
  const ViewGrid grid = ToViewGrid("front,left,top/camera");
  EXPECT_EQ(grid.columns, 3);
  EXPECT_THAT(ToViewGrid("2x2").cameras, ElementsAre("front", "right", "top", "three_quarter"));
  EXPECT_THAT(Complaint([] { ToViewGrid("front/left,top"); }), HasSubstr("row 2 has 2"));
  EXPECT_THAT(Complaint([] { ToViewGrid("front,top//left,right"); }), HasSubstr("row 2 has 0"));
  EXPECT_THAT(Complaint([] {
                ViewOptions options;
                options.views = "front,nowhere";
                ShotPlanner planner(options);
              }),
              HasSubstr("nowhere"));
}

TEST(ViewOptions, APlotIsOfJointsThatHaveALoad) {
  EXPECT_THAT(ToPlotJoints("l5_s1,right_elbow"), ElementsAre(urdf::jL5S1, urdf::jRightElbow));
  EXPECT_THAT(Complaint([] { ToPlotJoints("right_toe"); }), HasSubstr("right_knee"));
}

SceneState SceneAt(double secs, double ratio) {
  SceneState state = kinescope::testing::SceneWith(kinescope::testing::Posture::kStanding);
  state.stamp_nanos = 1'000'000'000 + std::llround(1e9 * secs);
  kinescope::testing::LoadOf(state, urdf::jL5S1).ratio = ratio;
  return state;
}

TEST(ShotPlanner, APlotShowsTheWholeClipThatWasSurveyedAndElseTheNewestSeconds) {
  ViewOptions options;
  options.plot = "l5_s1";
  ShotPlanner surveyed(options), growing(options);
  for (int k = 0; k <= 40; ++k) surveyed.Survey(SceneAt(0.5 * k, 0.01 * k));
  for (int k = 0; k <= 40; ++k) {
    const SceneState scene = SceneAt(0.5 * k, 0.01 * k);
    const Shot whole = surveyed.Next(scene), newest = growing.Next(scene);
    ASSERT_TRUE(whole.view.history && newest.view.history && whole.view.parts.plot);
    EXPECT_NEAR(whole.view.plot_secs, 0.5 * k, 1e-9);
    EXPECT_EQ(whole.view.history->curves.at(0).points.size(), 41u);
    EXPECT_NEAR(whole.view.history->to_secs, 20, 1e-9);
    const auto& points = newest.view.history->curves.at(0).points;
    EXPECT_EQ(points.size(), static_cast<std::size_t>(std::min(k, 20) + 1)) << "10 s";
    EXPECT_EQ(points.back().ratio, 0.01 * k);
    EXPECT_GE(points.front().secs, newest.view.history->from_secs - 1e-6);
  }
}

}  // namespace
}  // namespace kinescope::app
