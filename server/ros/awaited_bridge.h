/// Stands in for the bridge of `--ros auto` until there is one: a server that runs while its ROS
/// module is still being built or installed publishes as soon as it is there.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "server/ros/bridge.h"

namespace kinescope::ros_bridge {

/// Nothing is published, and status() has no master, before `make` returns a bridge; then all calls
/// are passed on to it.
class AwaitedBridge : public RosBridge {
 public:
  /// Called on a thread of its own, at once and then every `period`, until it returns a bridge or
  /// throws, which is logged.
  using Make = std::function<std::unique_ptr<RosBridge>()>;
  AwaitedBridge(Make make, std::chrono::milliseconds period);
  ~AwaitedBridge() override;

  void Publish(const SceneState& state) override;
  void TakeInputs(InputSink& sink) override;
  BridgeStatus status() const override;
  void PublishDiagnostics(std::vector<Diagnosis> all, double suit_hz) override;
  bool PublishState(const std::string& state) override;
  bool PublishLog(const RosLogLine& line) override;
  bool PublishMark(const RosMark& mark) override;
  void PublishView(const RosImage& picture) override;

 private:
  void Await();

  const Make make_;
  const std::chrono::milliseconds period_;
  std::unique_ptr<RosBridge> bridge_;      // of thread_ until it has ended
  std::atomic<RosBridge*> made_{nullptr};  // bridge_, once it is complete
  std::mutex mutex_;
  std::condition_variable changed_;
  bool stopping_ = false;  // guarded by mutex_
  std::thread thread_;     // last: it uses the others
};

}  // namespace kinescope::ros_bridge
