#include "server/ros/awaited_bridge.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/deadline.h"

namespace kinescope::ros_bridge {
namespace {

// An event that has no other sign.
void Await(const std::function<bool()>& holds) {
  testing::WithDeadline([&] {
    while (!holds()) std::this_thread::yield();
  });
}

constexpr std::chrono::milliseconds kAtOnce(1);

// What reaches the bridge that was awaited, in order.
struct Calls {
  std::vector<std::string> names;
  std::atomic<bool> is_destroyed = false;
};

class RecordingBridge : public RosBridge {
 public:
  explicit RecordingBridge(Calls& calls) : calls_(calls) {}
  ~RecordingBridge() override { calls_.is_destroyed = true; }
  void Publish(const SceneState&) override { calls_.names.emplace_back("state of the scene"); }
  void TakeInputs(InputSink&) override { calls_.names.emplace_back("inputs"); }
  BridgeStatus status() const override {
    BridgeStatus status;
    status.master_reachable = true;
    return status;
  }
  void PublishDiagnostics(std::vector<Diagnosis> all, double) override {
    calls_.names.push_back(all.at(0).name);
  }
  bool PublishState(const std::string& state) override {
    calls_.names.push_back(state);
    return true;
  }
  bool PublishLog(const RosLogLine& line) override {
    calls_.names.push_back(line.text);
    return true;
  }
  bool PublishMark(const RosMark& mark) override {
    calls_.names.push_back(mark.text);
    return true;
  }
  void PublishView(const RosImage&) override { calls_.names.emplace_back("view"); }

 private:
  Calls& calls_;
};

class NoInputs : public InputSink {
 public:
  void OnHandLoad(int, const HandLoad&) override {}
  void OnMeasurements(int, const Measurements&) override {}
};

// Everything once; whether the last three were published.
std::vector<bool> CallAll(RosBridge& bridge) {
  NoInputs sink;
  bridge.Publish({});
  bridge.TakeInputs(sink);
  bridge.PublishDiagnostics({{Diagnosis::Level::kOk, "diagnosis", "", {}}}, 0);
  bridge.PublishView({0, 0, {}, 0, {}, 0});
  RosMark mark;
  mark.text = "mark";
  return {bridge.PublishState("state"), bridge.PublishLog({RosLogLine::Level::kInfo, "line"}),
          bridge.PublishMark(mark)};
}

TEST(AwaitedBridge, PublishesNothingUntilThereIsABridgeAndThenPassesOnEverything) {
  Calls calls;
  std::atomic<bool> is_there = false;
  std::atomic<int> looks = 0;
  AwaitedBridge bridge(
      [&]() -> std::unique_ptr<RosBridge> {
        ++looks;
        return is_there ? std::make_unique<RecordingBridge>(calls) : nullptr;
      },
      kAtOnce);
  EXPECT_EQ(CallAll(bridge), std::vector<bool>({false, false, false}));
  EXPECT_FALSE(bridge.status().master_reachable);
  Await([&] { return looks > 1; });
  EXPECT_TRUE(calls.names.empty());

  is_there = true;
  Await([&] { return bridge.status().master_reachable; });
  EXPECT_EQ(CallAll(bridge), std::vector<bool>({true, true, true}));
  EXPECT_EQ(calls.names, std::vector<std::string>({"state of the scene", "inputs", "diagnosis",
                                                   "view", "state", "line", "mark"}));
}

TEST(AwaitedBridge, EndsWhileItWaitsAndDestroysTheBridgeItHas) {
  {
    AwaitedBridge bridge([] { return nullptr; }, std::chrono::hours(1));
  }
  Calls calls;
  {
    AwaitedBridge bridge([&] { return std::make_unique<RecordingBridge>(calls); },
                         std::chrono::hours(1));
    Await([&] { return bridge.status().master_reachable; });
    EXPECT_FALSE(calls.is_destroyed);
  }
  EXPECT_TRUE(calls.is_destroyed);
}

TEST(AwaitedBridge, StaysWithoutRosWhenTheBridgeCannotBeMade) {
  std::atomic<int> looks = 0;
  AwaitedBridge bridge(
      [&]() -> std::unique_ptr<RosBridge> {
        ++looks;
        throw std::runtime_error("ROS_MASTER_URI=nonsense: expected http://<host>:<port>");
      },
      kAtOnce);
  Await([&] { return looks == 1; });
  EXPECT_EQ(CallAll(bridge), std::vector<bool>({false, false, false}));
}

}  // namespace
}  // namespace kinescope::ros_bridge
