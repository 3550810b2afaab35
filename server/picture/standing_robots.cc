#include "server/picture/standing_robots.h"

#include <spdlog/spdlog.h>

#include <cmath>

#include "core/system/errors.h"
#include "render/renderer.h"
#include "server/scene/robot_source.h"

namespace kinescope::app {
namespace {

constexpr double kApart = 1.2;  // m, between people and robots without a given place

// The root over the place, the lowest point on z = 0.
RobotState Stand(const RobotPlace& wanted, const RobotPlace::Place& place,
                 render::Renderer& renderer) {
  const std::string& file = wanted.file;
  RobotState robot = ReadRobot(file, {});
  SetOpacity(robot, wanted.opacity);
  for (const std::string& note : robot.model->notes) spdlog::warn("{}: {}", file, note);
  Eigen::Isometry3d world_from_root(Eigen::AngleAxisd(place.yaw, Eigen::Vector3d::UnitZ()));
  world_from_root.pretranslate(Eigen::Vector3d(place.x, place.y, 0));
  for (Eigen::Isometry3d& link : robot.world_from_link) link = world_from_root * link;
  robot.bounds = renderer.Bounds(robot);
  if (robot.bounds.isEmpty()) {
    throw SourceError(file + ": has no <visual>, so there is nothing to draw");
  }
  return Lifted(robot, -robot.bounds.min().z());
}

}  // namespace

std::vector<RobotState> ReadStandingRobots(const std::vector<RobotPlace>& places,
                                           const BackendOptions& backend) {
  std::vector<RobotState> robots;
  std::unique_ptr<render::Renderer> renderer;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i].tf_prefix) continue;
    if (!renderer) renderer = StartRenderer(backend);
    const RobotPlace::Place beside{0, kApart * static_cast<double>(i + 1), 0};
    robots.push_back(Stand(places[i], places[i].place.value_or(beside), *renderer));
  }
  return robots;
}

}  // namespace kinescope::app
