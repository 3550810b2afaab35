#include "server/picture/moving_robots.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "core/system/errors.h"
#include "server/scene/robot_source.h"

namespace kinescope::app {

std::vector<GraphRobot> ReadMovingRobots(const std::vector<RobotPlace>& places) {
  std::vector<GraphRobot> robots;
  for (const RobotPlace& place : places) {
    if (!place.tf_prefix) continue;
    GraphRobot robot{place.parameter, *place.tf_prefix, {}, place.opacity};
    if (!place.file.empty()) {
      robot.robot = ReadRobot(place.file, {});
      SetOpacity(robot.robot, place.opacity);
      for (const std::string& note : robot.robot.model->notes) {
        spdlog::warn("{}: {}", place.file, note);
      }
    }
    robots.push_back(std::move(robot));
  }
  return robots;
}

void AddBagView(const ViewOptions& options, SceneOptions& scene) {
  for (const RobotPlace& place : *options.robot) {
    if (place.parameter.empty()) continue;
    throw UsageError(
        fmt::format("--robot=ros:{}: only serve reads the parameters of a ROS graph; name the file "
                    "of the URDF: --robot=FILE.urdf@tf",
                    place.parameter));
  }
  scene.bag.needs_person = false;
  scene.bag.topics = *options.marker_topics;
  scene.bag.robots = ReadMovingRobots(*options.robot);
  scene.bag.camera_frame = scene.camera_frame = options.moves.camera_tf->frames();
}

}  // namespace kinescope::app
