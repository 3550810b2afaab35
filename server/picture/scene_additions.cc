#include "server/picture/scene_additions.h"

#include <utility>

#include "server/picture/standing_robots.h"
#include "server/scene/robot_source.h"

namespace kinescope::app {
SceneAdditions::SceneAdditions(const ViewOptions& options, const BackendOptions& backend,
                               const SceneOptions& people)
    : trails_(options.trails.Settings()),
      ghost_(options.ghost, *options.ghost_opacity, people),
      robots_(ReadStandingRobots(*options.robot, backend)) {}

void SceneAdditions::AddTo(SceneState& state, render::SceneLook& look) const {
  look.trails = trails_.Make();
  look.ghosts = ghost_.Make(state);
  AddRobotsTo(state, state.floor_z);
}

void SceneAdditions::AddNamesTo(SceneState& state, render::SceneLook& look) const {
  look.trails = trails_.WithoutPoints();
  look.ghosts = ghost_.Make(state);
  AddRobotsTo(state, state.floor_z);
}

std::vector<Ball> SceneAdditions::BallsBeside(const SceneState& state) const {
  SceneState beside;
  beside.robots = state.robots;  // of the recording
  for (Ghost& ghost : ghost_.Make(state)) beside.people.push_back(std::move(ghost.person));
  AddRobotsTo(beside, state.floor_z);
  return render::BallsOf(beside);
}

void SceneAdditions::AddRobotsTo(SceneState& state, double floor_z) const {
  for (const RobotState& robot : robots_) state.robots.push_back(Lifted(robot, floor_z));
}

}  // namespace kinescope::app
