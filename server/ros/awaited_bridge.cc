#include "server/ros/awaited_bridge.h"

#include <spdlog/spdlog.h>

#include <exception>
#include <utility>

namespace kinescope::ros_bridge {

AwaitedBridge::AwaitedBridge(Make make, std::chrono::milliseconds period)
    : make_(std::move(make)), period_(period), thread_([this] { Await(); }) {}

AwaitedBridge::~AwaitedBridge() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void AwaitedBridge::Await() try {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopping_) {
    lock.unlock();
    bridge_ = make_();
    made_ = bridge_.get();
    if (bridge_) return;
    lock.lock();
    changed_.wait_for(lock, period_, [this] { return stopping_; });
  }
} catch (const std::exception& error) {
  spdlog::warn("ROS is not used: {}", error.what());
}

void AwaitedBridge::Publish(const SceneState& state) {
  if (RosBridge* const bridge = made_) bridge->Publish(state);
}

void AwaitedBridge::TakeInputs(InputSink& sink) {
  if (RosBridge* const bridge = made_) bridge->TakeInputs(sink);
}

BridgeStatus AwaitedBridge::status() const {
  const RosBridge* const bridge = made_;
  return bridge != nullptr ? bridge->status() : BridgeStatus();
}

void AwaitedBridge::PublishDiagnostics(std::vector<Diagnosis> all, double suit_hz) {
  if (RosBridge* const bridge = made_) bridge->PublishDiagnostics(std::move(all), suit_hz);
}

bool AwaitedBridge::PublishState(const std::string& state) {
  RosBridge* const bridge = made_;
  return bridge != nullptr && bridge->PublishState(state);
}

bool AwaitedBridge::PublishLog(const RosLogLine& line) {
  RosBridge* const bridge = made_;
  return bridge != nullptr && bridge->PublishLog(line);
}

bool AwaitedBridge::PublishMark(const RosMark& mark) {
  RosBridge* const bridge = made_;
  return bridge != nullptr && bridge->PublishMark(mark);
}

void AwaitedBridge::PublishView(const RosImage& picture) {
  if (RosBridge* const bridge = made_) bridge->PublishView(picture);
}

}  // namespace kinescope::ros_bridge
