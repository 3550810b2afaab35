#include "server/picture/scene_extras.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <array>
#include <cmath>
#include <sstream>
#include <utility>

#include "core/errors.h"
#include "render/renderer.h"
#include "server/options/option_list.h"
#include "server/scene/robot_source.h"

namespace kinescope::app {
namespace {

constexpr double kApart = 1.2;           // m, between people and robots that nobody placed
constexpr double kFarthestRobot = 1000;  // m

struct RobotPlace {
  std::string file;
  double x = 0, y = 0, yaw = 0;  // m, m, rad
};

// A name may hold an @ of its own: what follows the last one is a place when it looks like one.
RobotPlace ToPlace(const std::string& text, std::size_t index) {
  RobotPlace place{text, 0, kApart * static_cast<double>(index + 1), 0};
  const std::size_t at = text.rfind('@');
  const char* const kStartOfNumber = "0123456789+-.";
  if (at == std::string::npos || text.find_first_of(kStartOfNumber, at + 1) != at + 1) return place;
  place.file = text.substr(0, at);
  std::array<double, 3> numbers{};
  std::istringstream list(text.substr(at + 1));
  std::size_t count = 0;
  for (std::string number; std::getline(list, number, ','); ++count) {
    if (count == numbers.size()) break;
    numbers[count] = ParseOption<double>("--robot: a number of " + text, number);
    if (!(std::abs(numbers[count]) <= kFarthestRobot)) {
      throw UsageError(fmt::format("--robot={}: expected numbers up to {}", text, kFarthestRobot));
    }
  }
  if (count < 2 || !list.eof()) {
    throw UsageError("--robot=" + text + ": expected FILE.urdf@X,Y or FILE.urdf@X,Y,YAW");
  }
  place.x = numbers[0];
  place.y = numbers[1];
  place.yaw = numbers[2] * M_PI / 180;
  return place;
}

// The root over the place, the lowest point on z = 0.
RobotState Stand(const RobotPlace& place, render::Renderer& renderer) {
  RobotState robot = LoadRobot(place.file, {});
  for (const std::string& note : robot.model->notes) spdlog::warn("{}: {}", place.file, note);
  Eigen::Isometry3d world_from_root(Eigen::AngleAxisd(place.yaw, Eigen::Vector3d::UnitZ()));
  world_from_root.pretranslate(Eigen::Vector3d(place.x, place.y, 0));
  for (Eigen::Isometry3d& link : robot.world_from_link) link = world_from_root * link;
  robot.bounds = renderer.Bounds(robot);
  if (robot.bounds.isEmpty()) {
    throw SourceError(place.file + ": has no <visual>, so there is nothing to draw");
  }
  const Eigen::Vector3d up(0, 0, -robot.bounds.min().z());
  for (Eigen::Isometry3d& link : robot.world_from_link) link.pretranslate(up);
  robot.bounds.translate(up);
  return robot;
}

std::vector<RobotState> ReadRobots(const std::vector<std::string>& texts,
                                   const BackendOptions& backend) {
  std::vector<RobotState> robots;
  if (texts.empty()) return robots;
  const auto renderer = StartRenderer(backend);
  for (std::size_t i = 0; i < texts.size(); ++i) {
    robots.push_back(Stand(ToPlace(texts[i], i), *renderer));
  }
  return robots;
}

}  // namespace

SceneExtras::SceneExtras(const ViewOptions& options, const BackendOptions& backend,
                         const SceneOptions& people)
    : trails_(options.trail, options.trail_secs),
      ghost_(options.ghost, options.ghost_opacity, people),
      robots_(ReadRobots(options.robot, backend)) {}

void SceneExtras::AddTo(SceneState& state, render::SceneLook& look) const {
  look.trails = trails_.Make();
  look.ghosts = ghost_.Make(state);
  const Eigen::Vector3d up(0, 0, state.floor_z);
  for (const RobotState& robot : robots_) {
    state.robots.push_back(robot);
    for (Eigen::Isometry3d& link : state.robots.back().world_from_link) link.pretranslate(up);
    state.robots.back().bounds.translate(up);
  }
}

}  // namespace kinescope::app
