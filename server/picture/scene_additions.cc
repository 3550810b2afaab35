#include "server/picture/scene_additions.h"

#include <spdlog/spdlog.h>

#include <cmath>
#include <utility>

#include "core/system/errors.h"
#include "render/renderer.h"
#include "server/scene/robot_source.h"

namespace kinescope::app {
namespace {

constexpr double kApart = 1.2;  // m, between people and robots without a given place

// The root over the place, the lowest point on z = 0.
RobotState Stand(const std::string& file, const RobotPlace::Place& place,
                 render::Renderer& renderer) {
  RobotState robot = ReadRobot(file, {});
  for (const std::string& note : robot.model->notes) spdlog::warn("{}: {}", file, note);
  Eigen::Isometry3d world_from_root(Eigen::AngleAxisd(place.yaw, Eigen::Vector3d::UnitZ()));
  world_from_root.pretranslate(Eigen::Vector3d(place.x, place.y, 0));
  for (Eigen::Isometry3d& link : robot.world_from_link) link = world_from_root * link;
  robot.bounds = renderer.Bounds(robot);
  if (robot.bounds.isEmpty()) {
    throw SourceError(file + ": has no <visual>, so there is nothing to draw");
  }
  const Eigen::Vector3d up(0, 0, -robot.bounds.min().z());
  for (Eigen::Isometry3d& link : robot.world_from_link) link.pretranslate(up);
  robot.bounds.translate(up);
  return robot;
}

std::vector<RobotState> ReadRobots(const std::vector<RobotPlace>& places,
                                   const BackendOptions& backend) {
  std::vector<RobotState> robots;
  if (places.empty()) return robots;
  const auto renderer = StartRenderer(backend);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const RobotPlace::Place beside{0, kApart * static_cast<double>(i + 1), 0};
    robots.push_back(Stand(places[i].file, places[i].place.value_or(beside), *renderer));
  }
  return robots;
}

}  // namespace

SceneAdditions::SceneAdditions(const ViewOptions& options, const BackendOptions& backend,
                               const SceneOptions& people)
    : trails_(*options.trail, *options.trail_secs),
      ghost_(options.ghost, *options.ghost_opacity, people),
      robots_(ReadRobots(*options.robot, backend)) {}

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
  for (render::Ghost& ghost : ghost_.Make(state)) beside.people.push_back(std::move(ghost.person));
  AddRobotsTo(beside, state.floor_z);
  return render::BallsOf(beside);
}

void SceneAdditions::AddRobotsTo(SceneState& state, double floor_z) const {
  const Eigen::Vector3d up(0, 0, floor_z);
  for (const RobotState& robot : robots_) {
    state.robots.push_back(robot);
    for (Eigen::Isometry3d& link : state.robots.back().world_from_link) link.pretranslate(up);
    state.robots.back().bounds.translate(up);
  }
}

}  // namespace kinescope::app
