/// The program as a ROS node beside others, with a real master on a port of its own. roscpp is one
/// node per process and cannot be started twice: each test needs a process of its own, which ctest
/// gives it.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <chrono>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "tests/folders.h"
#include "tests/free_port.h"
#include "tests/process.h"
#include "tests/system/kinescope_path.h"
#include "tests/temp_folder.h"

namespace kinescope::testing {

class RosProgram : public ::testing::Test {
 protected:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::seconds kPatience{60};  // only a failure takes so long

  void SetUp() override {
    if (ros::isInitialized()) GTEST_SKIP() << "needs a process of its own: run it through ctest";
    setenv("ROS_HOME", folder_.path().c_str(), 1);
    setenv("ROS_LOG_DIR", folder_.path().c_str(), 1);
    setenv("XDG_CACHE_HOME", folder_.path().c_str(), 1);
    setenv("ROS_MASTER_URI", fmt::format("http://127.0.0.1:{}", port_.number()).c_str(), 1);
    setenv("ROS_IP", "127.0.0.1", 1);
    unsetenv("ROS_HOSTNAME");
    StartMaster();
    std::string name = "listening_test";
    char* arguments[] = {name.data(), nullptr};
    int count = 1;
    ros::init(count, arguments, name, ros::init_options::NoSigintHandler);
    ASSERT_TRUE(ros::master::check()) << "the master does not answer";
    node_ = std::make_unique<ros::NodeHandle>();
  }

  /// At the same place whenever it is started.
  void StartMaster() {
    master_ = std::make_unique<Process>(std::vector<std::string>{
        KINESCOPE_PYTHON, InSourceTree("tests/system/ros/master.py").string(),
        std::to_string(port_.number())});
    ASSERT_TRUE(master_->ReadLine(kPatience)) << "the master does not start";
  }

  /// A kinescope process whose log can be read line by line.
  static std::unique_ptr<Process> Start(const std::string& arguments) {
    return std::make_unique<Process>(std::vector<std::string>{
        "/bin/bash", "-c", "exec '" + testing::KinescopePath() + "' " + arguments + " 2>&1"});
  }

  /// The rest of the first line that contains `text`.
  static std::string WaitForLine(Process& process, const std::string& text) {
    std::string seen;
    while (const auto line = process.ReadLine(kPatience)) {
      seen += *line + "\n";
      const std::size_t at = line->find(text);
      if (at != std::string::npos) return line->substr(at + text.size());
    }
    ADD_FAILURE() << "no line with '" << text << "' in:\n" << seen;
    return "";
  }

  /// The address that a program waits at for a suit: udp://127.0.0.1:PORT.
  static std::string WaitForAddress(Process& process) {
    const std::string rest = WaitForLine(process, "waiting for data from ");
    return rest.substr(0, rest.find(": "));
  }

  /// Takes what comes on subscribed topics until `condition` holds; false when it never does.
  template <class Condition>
  static bool Spin(const Condition& condition) {
    const auto deadline = Clock::now() + kPatience;
    while (!condition()) {
      if (Clock::now() > deadline) return false;
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.05));
    }
    return true;
  }

  /// A parameter of text, once somebody has set it; topics may be there before it.
  static std::string WaitForParameter(const std::string& name) {
    std::string text;
    EXPECT_TRUE(Spin([&] { return ros::param::get(name, text); })) << name;
    return text;
  }

  template <class Message, class Callback>
  void Hear(const std::string& topic, Callback on_message) {
    const boost::function<void(const boost::shared_ptr<const Message>&)> callback =
        [on_message](const auto& message) { on_message(*message); };
    subscribers_.push_back(node_->subscribe<Message>(topic, 0, callback, ros::VoidConstPtr(),
                                                     ros::TransportHints().tcpNoDelay()));
  }

  const FreePort port_;  // the master's
  TempFolder folder_;
  std::unique_ptr<Process> master_;
  std::unique_ptr<ros::NodeHandle> node_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace kinescope::testing
