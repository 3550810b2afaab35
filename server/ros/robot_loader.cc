#include "server/ros/robot_loader.h"

#include <spdlog/spdlog.h>

#include <memory>
#include <stdexcept>
#include <utility>

#include "server/download/robot_meshes.h"
#include "urdf/robot/mesh_uri.h"
#include "urdf/robot/robot_model.h"

namespace kinescope::ros_bridge {

RobotLoader::RobotLoader(std::function<void(std::size_t, RobotState)> on_loaded)
    : on_loaded_(std::move(on_loaded)), thread_([this] { Run(); }) {}

RobotLoader::~RobotLoader() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stops_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void RobotLoader::Load(std::size_t i, RobotState robot) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_.insert_or_assign(i, std::move(robot));
  }
  changed_.notify_all();
}

void RobotLoader::Run() {
  while (true) {
    std::size_t i = 0;
    RobotState robot;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait(lock, [this] { return stops_ || !waiting_.empty(); });
      if (stops_) return;
      auto first = waiting_.extract(waiting_.begin());
      i = first.key();
      robot = std::move(first.mapped());
    }
    const auto is_stopped = [this] {
      const std::lock_guard<std::mutex> lock(mutex_);
      return stops_;
    };
    const auto search = std::make_shared<urdf::MeshSearch>(*robot.meshes);
    try {
      download::LoadRemoteMeshes(*robot.model, *search, is_stopped);
    } catch (const std::runtime_error& error) {
      spdlog::warn("robot '{}': its meshes cannot be loaded: {}", robot.name, error.what());
    }
    if (is_stopped()) return;
    robot.meshes = search;
    on_loaded_(i, std::move(robot));
  }
}

}  // namespace kinescope::ros_bridge
