/// A bridge against a real master (rosmaster, a process of its own) and a real subscriber
/// (ros_listener, another). roscpp is one node per process and cannot be started twice, so each
/// test needs a process of its own, which ctest gives it.
#pragma once

#include <gtest/gtest.h>
#include <ros/init.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "server/ros/bridge.h"
#include "server/ros/init.h"
#include "server/ros/master_client.h"
#include "tests/folders.h"
#include "tests/free_port.h"
#include "tests/process.h"
#include "tests/server/ros/test_person.h"
#include "tests/temp_folder.h"

namespace kinescope::ros_bridge {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

inline constexpr std::int64_t kEpochNanos = 1'700'000'000'000'000'000;
inline constexpr std::chrono::seconds kTestPatience{60};  // only a failure takes so long
inline constexpr auto kPeriod = std::chrono::nanoseconds(1s) / 240;

class RosBridgeWithMaster : public ::testing::Test {
 protected:
  void SetUp() override {
    if (ros::isInitialized()) GTEST_SKIP() << "needs a process of its own: run it through ctest";
    setenv("ROS_HOME", folder_.path().c_str(), 1);
    setenv("ROS_LOG_DIR", folder_.path().c_str(), 1);
    setenv("ROS_MASTER_URI", ("http://127.0.0.1:" + std::to_string(port_.number())).c_str(), 1);
    setenv("ROS_IP", own_address(), 1);
    unsetenv("ROS_HOSTNAME");
    std::vector<std::string> words = {"test", "left", "_udp_port:=8001", "_tf:=tree", "right"};
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    int argc = static_cast<int>(argv.size());
    TakeRosArguments(argc, argv.data(), "kinescope");
    InitRos();
    argv.resize(static_cast<std::size_t>(argc));
    remaining_.assign(argv.begin(), argv.end());
  }

  void TearDown() override { bridge_.reset(); }

  // By which this node says that it can be reached.
  virtual const char* own_address() const { return "127.0.0.1"; }

  void StartMaster() {
    master_ = std::make_unique<testing::Process>(std::vector<std::string>{
        KINESCOPE_PYTHON, KINESCOPE_ROSMASTER, "--core", "-p", std::to_string(port_.number())});
    ASSERT_TRUE(Within(kTestPatience, [] { return MasterIsReachable(); }))
        << "rosmaster does not come up";
  }
  void KillMaster() { master_.reset(); }

  void MakeBridge(BridgeConfig config = {}) { bridge_ = MakeRosBridge(config, RosMode::kAuto); }

  // Publishes a new sample every 1/240 s until `done` or the deadline.
  bool PublishUntil(const std::function<bool()>& done, std::chrono::seconds limit = kTestPatience) {
    const auto deadline = Clock::now() + limit;
    for (auto next = Clock::now(); Clock::now() < deadline; next += kPeriod) {
      if (done()) return true;
      std::this_thread::sleep_until(next);  // the pace of a suit, not a wait for something
      PublishNext();
    }
    return false;
  }

  // One more sample of the person. Its stamp counts up; so does ~com's x, which has no stamp.
  void PublishNext() {
    ++counter_;
    PersonState person =
        testing::MakePerson(model_, testing::Posture(0.01 * counter_), counter_, StampNow());
    person.com = Eigen::Vector3d(static_cast<double>(StampNow() - kEpochNanos), 0, 1);
    Publish(testing::SceneWith(std::move(person)));
  }

  void Publish(const SceneState& state) {
    const auto before = Clock::now() - TimeInWhichThisThreadCouldRun();
    bridge_->Publish(state);
    const std::chrono::duration<double, std::milli> waited =
        Clock::now() - TimeInWhichThisThreadCouldRun() - before;
    longest_wait_millis_ = std::max(longest_wait_millis_, waited.count());
  }

  // On a core or in the queue for one: a thread that waits for something else does neither, and a
  // busy machine only makes the queue longer.
  static std::chrono::nanoseconds TimeInWhichThisThreadCouldRun() {
    std::ifstream file("/proc/thread-self/schedstat");
    std::int64_t running = 0, in_queue = 0;
    EXPECT_TRUE(file >> running >> in_queue);
    return std::chrono::nanoseconds(running + in_queue);
  }

  std::int64_t StampNow() const { return kEpochNanos + counter_ * kPeriod.count(); }

  // A node that subscribes to everything and has heard something on every topic.
  std::unique_ptr<testing::Process> Listen() {
    auto listener = std::make_unique<testing::Process>(std::vector<std::string>{
        kinescope::testing::InBuild("tests/server/ros/ros_listener").string(), "/kinescope/",
        std::to_string(kEpochNanos)});
    EXPECT_TRUE(PublishUntil([&] { return listener->ReadLine(0ms) == "heard"; }))
        << "the listener does not hear every topic";
    return listener;
  }

  enum class Description { kThere, kNone };
  enum class Pace { kSuit, kBurst };

  // Publishes `samples` and expects each of them once on every topic.
  void ExpectEveryOneOnce(testing::Process& listener, int samples,
                          Description description = Description::kThere, Pace pace = Pace::kSuit) {
    const std::int64_t first = StampNow() + 1;
    const std::uint32_t end = counter_ + static_cast<std::uint32_t>(samples);
    while (pace == Pace::kBurst && counter_ < end) PublishNext();
    ASSERT_TRUE(PublishUntil([&] { return counter_ == end; }));
    const std::int64_t last = StampNow();
    if (description == Description::kThere) {
      EXPECT_TRUE(PublishUntil([] { return IsSet("/robot_description"); })) << "never described";
    }
    PublishNext();  // tells the listener that nothing of the range is still under way
    listener.WriteLine("report " + std::to_string(first) + " " + std::to_string(last));
    const std::string all = " " + std::to_string(samples);
    for (const char* topic :
         {"/kinescope/com", "/kinescope/com_stamped", "/kinescope/cop", "/kinescope/joint_states",
          "/kinescope/link_states", "/kinescope/markers", "/tf"}) {
      EXPECT_EQ(listener.ReadLine(kTestPatience).value_or("nothing"), topic + all + all + " 0");
    }
    EXPECT_EQ(listener.ReadLine(kTestPatience).value_or("nothing"),
              description == Description::kThere ? "urdf 67 66" : "urdf 0 0");
  }

  static bool IsSet(const std::string& parameter) {
    XmlRpc::XmlRpcValue arguments;
    arguments[0] = parameter;
    const MasterReply reply = MasterClient().Call("hasParam", arguments);
    return reply.value == XmlRpc::XmlRpcValue(true);
  }

  template <class Condition>
  static bool Within(std::chrono::seconds limit, const Condition& holds) {
    const auto deadline = Clock::now() + limit;
    while (!holds()) {
      if (Clock::now() > deadline) return false;
      std::this_thread::sleep_for(10ms);  // another process's progress: there is nothing to wait on
    }
    return true;
  }

  const testing::FreePort port_;  // the master's
  const testing::TempFolder folder_;
  std::vector<std::string> remaining_;  // of argv, after InitRos
  std::shared_ptr<const PersonModel> model_ = testing::MakeModel();
  std::unique_ptr<testing::Process> master_;
  std::unique_ptr<RosBridge> bridge_;
  std::uint32_t counter_ = 0;
  double longest_wait_millis_ = 0;
};

}  // namespace kinescope::ros_bridge
