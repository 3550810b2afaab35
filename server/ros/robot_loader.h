/// Loads the meshes of robots that are on web servers, on a thread of its own: the thread that asks
/// the master never waits for them.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <map>
#include <mutex>
#include <thread>

#include "core/robot_state.h"

namespace kinescope::ros_bridge {

class RobotLoader {
 public:
  /// @param on_loaded  called on that thread, with the robot and the search that finds its meshes
  explicit RobotLoader(std::function<void(std::size_t i, RobotState robot)> on_loaded);
  /// Ends loading, within about a second.
  ~RobotLoader();
  RobotLoader(const RobotLoader&) = delete;
  RobotLoader& operator=(const RobotLoader&) = delete;

  /// Of robot `i` the newest. Any thread.
  void Load(std::size_t i, RobotState robot);

 private:
  void Run();

  const std::function<void(std::size_t, RobotState)> on_loaded_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::size_t, RobotState> waiting_;  // guarded by mutex_
  bool stops_ = false;                         // guarded by mutex_
  std::thread thread_;
};

}  // namespace kinescope::ros_bridge
