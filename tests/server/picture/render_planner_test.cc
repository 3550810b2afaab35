// What pictures show of the time before, and beside the recording.

#include "server/picture/render_planner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "core/system/errors.h"
#include "core/system/stop_signal.h"
#include "tests/server/options_testing.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

using ::testing::HasSubstr;

std::vector<SceneState> Scenes(const char* url, int count) {
  SceneReader reader(url, SceneOptions());
  SceneTimeline timeline(reader);
  std::vector<SceneState> scenes;
  for (int i = 0; i < count; ++i) scenes.push_back(timeline.At(0.1 * i).value());
  return scenes;
}

TEST(RenderPlanner, GivesTrailsTheRequestedPointsAndTime) {
  const auto options =
      testing::With<ViewOptions>({{"trail", "com,RightHand"}, {"trail_secs", "0.5"}});
  RenderPlanner planner(options);
  const std::vector<SceneState> scenes = Scenes("demo:lift", 12);
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const RenderRequest request = planner.Next(scenes[i]);
    const auto& trails = request.spec.look.trails;
    if (i == 0) {
      EXPECT_TRUE(trails.empty()) << "a point is no trail";
      continue;
    }
    ASSERT_EQ(trails.size(), 2u);
    EXPECT_EQ(trails[0].points.size(), std::min<std::size_t>(i + 1, 6)) << "five steps of 0.1 s";
    EXPECT_EQ(trails[0].points.back(), *scenes[i].people[0].com);
    EXPECT_EQ(trails[1].points.back(), scenes[i].people[0].links[urdf::kRightHand].position);
  }
  // A recording that starts over drags no line through the room.
  EXPECT_TRUE(planner.Next(scenes[0]).spec.look.trails.empty());
}

TEST(RenderPlanner, GivesASinglePictureTheTrailOfAClip) {
  const auto options = testing::With<ViewOptions>({{"trail", "left_hand"}, {"trail_secs", "1"}});
  SceneReader reader("demo:walk", SceneOptions());
  SceneTimeline timeline(reader);
  RenderPlanner planner(options);
  RememberBefore(2, timeline, planner);
  const RenderRequest request = planner.Only(timeline.At(2).value());
  ASSERT_EQ(request.spec.look.trails.size(), 1u);
  EXPECT_EQ(request.spec.look.trails[0].points.size(), 61u) << "60 a second and now";
}

TEST(RenderPlanner, PutsAReferencePoseOnTheFloorAtThePerson) {
  for (const char* pose : {"n_pose", "t_pose"}) {
    const auto options = testing::With<ViewOptions>({{"ghost", pose}, {"ghost_opacity", "0.2"}});
    RenderPlanner planner(options);
    const SceneState scene = Scenes("demo:lift", 25).back();
    const RenderRequest request = planner.Only(scene);
    ASSERT_EQ(request.spec.look.ghosts.size(), 1u);
    const Ghost& ghost = request.spec.look.ghosts[0];
    EXPECT_EQ(ghost.opacity, 0.2);
    const urdf::LinkPoses& links = ghost.person.links;
    const auto& pelvis = scene.people[0].links[urdf::kPelvis].position;
    EXPECT_NEAR((links[urdf::kPelvis].position - pelvis).head<2>().norm(), 0, 1e-9);
    EXPECT_GT(links[urdf::kPelvis].position.z(), pelvis.z() + 0.05) << "upright, not bent";
    EXPECT_NEAR(links[urdf::kRightToe].position.z(), links[urdf::kLeftToe].position.z(), 1e-6);
    EXPECT_LT(links[urdf::kRightToe].position.z(), 0.1);
    const double reach = links[urdf::kLeftHand].position.y() - links[urdf::kRightHand].position.y();
    if (std::string(pose) == "t_pose") {
      EXPECT_GT(reach, 1.2);
    } else {
      EXPECT_LT(reach, 0.7);
    }
  }
}

TEST(RenderPlanner, PutsAReferencePoseOfARecordingAtItsRecordedPlace) {
  const auto options = testing::With<ViewOptions>({{"ghost", "demo:lift@1.5"}});
  RenderPlanner planner(options);
  const std::vector<SceneState> scenes = Scenes("demo:lift", 16);
  const RenderRequest request = planner.Only(scenes[0]);
  EXPECT_EQ(request.spec.look.ghosts.at(0).person.links[urdf::kHead].position,
            scenes[15].people[0].links[urdf::kHead].position);
}

TEST(RenderPlanner, RejectsAnInvalidTimeOfAReferencePose) {
  for (const std::string secs : {"-1", "864001", "1e9", "1e300", "inf", "nan"}) {
    EXPECT_THAT(testing::ErrorOfSetting<ViewOptions>("ghost", "demo:lift@" + secs),
                HasSubstr("0 to 864000 s"));
  }
}

// In a process of its own, whose flag stays set and which ends if it reads on.
TEST(ShotsDeathTest, EndOnCtrlCWhileReadingAReferencePose) {
  const auto options = testing::With<ViewOptions>({{"ghost", "demo:lift@3600"}});
  const auto read = [&] {
    alarm(20);
    CatchStopSignals();
    std::raise(SIGINT);
    try {
      const RenderPlanner planner(options);
    } catch (const std::runtime_error& error) {
      std::fprintf(stderr, "%s\n", error.what());
      std::_Exit(2);
    }
    std::_Exit(0);
  };
  EXPECT_EXIT(read(), ::testing::ExitedWithCode(2), "interrupted while reading demo:lift");
}

TEST(RenderPlanner, PutsRobotsOnTheFloorAtTheirGivenPlaces) {
  const testing::TempFolder folder;
  const std::string file = (folder / "arm@home.urdf").string();
  std::ofstream(file)
      << "<robot name='arm'><link name='base'><visual><geometry><box size='1 .2 .4'/>"
         "</geometry></visual></link></robot>";
  ViewOptions options;
  options.robot.ParseAll({file + "@2,-1,90", file});
  RenderPlanner planner(options);
  SceneState scene;
  scene.floor_z = 0.5;
  const SceneState shown = planner.Only(scene).state;
  ASSERT_EQ(shown.robots.size(), 2u);
  const RobotState& placed = shown.robots[0];
  EXPECT_TRUE(placed.world_from_link[0].translation().isApprox(Eigen::Vector3d(2, -1, 0.7), 1e-6));
  EXPECT_NEAR(placed.bounds.min().z(), 0.5, 1e-6);
  EXPECT_NEAR(placed.bounds.sizes().y(), 1, 1e-6) << "turned by 90 degrees";
  EXPECT_GT(shown.robots[1].bounds.min().y(), 1) << "beside whoever is in the middle";
}

RenderRequest MomentsOf(const char* views, const char* source,
                        const std::vector<std::pair<std::string, std::string>>& more = {}) {
  std::vector<std::pair<std::string, std::string>> values = more;
  values.emplace_back("views", views);
  RenderPlanner planner(testing::With<ViewOptions>(values));
  SceneReader reader(source, SceneOptions());
  SceneTimeline timeline(reader);
  for (const double secs : planner.moment_times()) planner.AddMoment(timeline.At(secs).value());
  return planner.Moments();
}

TEST(RenderPlanner, ShowsMomentsInTheGivenOrderWithOneScale) {
  for (const char* source : {"demo:lift", "demo:walk"}) {
    const RenderRequest request = MomentsOf("time:1.5,0/0.5", source);
    ASSERT_EQ(request.spec.panes.size(), 3u);
    EXPECT_EQ(request.spec.pane_columns, 2);
    EXPECT_EQ(request.spec.panes[0].name, "1.5 s");
    EXPECT_EQ(request.spec.panes[1].name, "0 s");
    EXPECT_EQ(request.spec.panes[2].name, "0.5 s");
    EXPECT_FALSE(request.spec.parts.time) << "each view has its own";
    const auto stamp = [&](std::size_t i) {
      return request.spec.panes[i].scene->state.stamp_nanos;
    };
    EXPECT_EQ(stamp(0) - stamp(1), 1'500'000'000);
    EXPECT_EQ(request.state.stamp_nanos, stamp(0)) << "the first view's";
    const auto distance = [&](std::size_t i) {
      const render::Camera& camera = request.spec.panes[i].camera;
      return (camera.position - camera.target).norm();
    };
    EXPECT_NEAR(distance(0), distance(1), 1e-9);
    EXPECT_NEAR(distance(0), distance(2), 1e-9);
    const Eigen::Vector3d ahead =
        request.spec.panes[0].camera.target - request.spec.panes[0].camera.position;
    const Eigen::Vector3d ahead_later =
        request.spec.panes[2].camera.target - request.spec.panes[2].camera.position;
    EXPECT_NEAR((ahead - ahead_later).norm(), 0, 1e-9) << "seen from the same side";
  }
}

TEST(RenderPlanner, GivesEachMomentItsOwnTrail) {
  const auto options = testing::With<ViewOptions>(
      {{"views", "time:0.5,1"}, {"trail", "right_hand"}, {"trail_secs", "10"}});
  RenderPlanner planner(options);
  SceneReader reader("demo:lift", SceneOptions());
  SceneTimeline timeline(reader);
  double before = 0;
  for (const double secs : planner.moment_times()) {
    RememberBefore(secs, timeline, planner, before);
    planner.AddMoment(timeline.At(secs).value());
    before = secs;
  }
  const RenderRequest request = planner.Moments();
  const auto points = [&](std::size_t i) {
    return request.spec.panes[i].scene->trails.at(0).points.size();
  };
  EXPECT_EQ(points(0), 31u) << "60 a second and now";
  EXPECT_EQ(points(1), 61u);
}

TEST(RenderPlanner, RejectsMomentsWithoutARecording) {
  const RenderPlanner planner(testing::With<ViewOptions>({{"views", "time:0,1"}}));
  EXPECT_THROW(planner.Only(Scenes("demo:lift", 1).front()), UsageError);
}

TEST(RenderPlanner, KeepsTheSceneClearOfALegendBelow) {
  const SceneState scene = Scenes("demo:lift", 1).front();
  const auto request = [&](const char* place) {
    return RenderPlanner(testing::With<ViewOptions>({{"legend", place}, {"ghost", "n_pose"}}))
        .Only(scene);
  };
  const RenderRequest inside = request("inside"), below = request("below");
  EXPECT_FALSE(inside.spec.scene.has_value());
  ASSERT_TRUE(below.spec.scene.has_value());
  EXPECT_EQ(below.spec.scene->width, below.spec.width);
  const auto& rows = below.spec.legend_content->rows;
  EXPECT_EQ(rows.back().name, "N-pose");
  for (const Ball& ball : render::BallsOf(scene)) {
    const render::Tile& tile = *below.spec.scene;
    const render::Projected at =
        render::Project(ball.center, below.camera, tile.width, tile.height);
    EXPECT_GT(at.y_px, 0);
    EXPECT_LT(at.y_px, tile.height);
  }
}

TEST(RenderPlanner, KeepsTheLegendOfAClip) {
  RenderPlanner planner(
      testing::With<ViewOptions>({{"legend", "below"}, {"trail", "right_hand"}}),
      SceneAdditions(testing::With<ViewOptions>({{"trail", "right_hand"}}), {}, {}), Fit::kClip);
  EXPECT_TRUE(planner.needs_prescan());
  const std::vector<SceneState> scenes = Scenes("demo:lift", 8);
  for (const SceneState& scene : scenes) planner.Prescan(scene);
  const RenderRequest first = planner.Next(scenes[0]);
  ASSERT_TRUE(first.spec.scene.has_value());
  EXPECT_TRUE(first.spec.look.trails.empty());
  EXPECT_EQ(first.spec.legend_content->rows.back().name, "path: right hand")
      << "the trail begins later";
  const RenderRequest later = planner.Next(scenes[7]);
  EXPECT_EQ(later.spec.scene->height, first.spec.scene->height);
  EXPECT_EQ(later.spec.legend_content->rows.size(), first.spec.legend_content->rows.size());
}

}  // namespace
}  // namespace kinescope::app
