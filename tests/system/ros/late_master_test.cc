// The program beside a ROS master whose answers come late, or never: a packet that the network lost
// costs a second.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <string>
#include <thread>

#include "tests/process.h"
#include "tests/server/ros/bad_master.h"
#include "tests/system/kinescope_path.h"

namespace kinescope {
namespace {

using testing::BadMaster;
using testing::Process;

constexpr std::chrono::seconds kPatience{60};  // only a failure takes so long

class LateMaster : public ::testing::Test {
 protected:
  static Process Start(const BadMaster& master, const std::string& options) {
    return StartProgram(master, "bridge demo:walk " + options);
  }

  static Process StartProgram(const BadMaster& master, const std::string& arguments) {
    setenv("ROS_MASTER_URI", fmt::format("http://127.0.0.1:{}", master.port()).c_str(), 1);
    setenv("ROS_IP", "127.0.0.1", 1);
    return Process(
        {"/bin/bash", "-c", "exec '" + testing::KinescopePath() + "' " + arguments + " 2>&1"});
  }

  /// What it logs up to the first line with `text`.
  static std::string LogUntil(Process& process, const std::string& text) {
    std::string log;
    while (const auto line = process.ReadLine(kPatience)) {
      log += *line + "\n";
      if (line->find(text) != std::string::npos) break;
    }
    return log;
  }
};

void AnswerLate(int connection, const std::string& request) {
  std::this_thread::sleep_for(std::chrono::milliseconds(1300));  // late is what this is about
  const auto answer = [&](const std::string& value) {
    testing::Send(connection, testing::Answer("<value><array><data><value><i4>1</i4></value>"
                                              "<value></value>" +
                                              value + "</data></array></value>"));
  };
  if (request.find("<methodName>getParam<") == std::string::npos) {
    return answer("<value><i4>100</i4></value>");
  }
  answer(
      "<value><struct><member><name>model_name</name><value>not a name</value></member></struct>"
      "</value>");
}

void NeverAnswer(int connection, const std::string&) {
  char byte = 0;
  recv(connection, &byte, 1, 0);  // until the program gives up
}

TEST_F(LateMaster, ParametersOfTheNodeAreWaitedFor) {
  const BadMaster master(AnswerLate);
  Process bridge = Start(master, "");
  const std::string log = LogUntil(bridge, "live: ");
  ASSERT_NE(log.find("~model_name=not a name"), std::string::npos) << log;
  EXPECT_EQ(bridge.WaitForEnd(), 2);
}

TEST_F(LateMaster, ThatNeverAnswersIsNamedWithWhatIsMissing) {
  const BadMaster master(NeverAnswer);
  Process bridge = Start(master, "");
  const std::string log = LogUntil(bridge, "live: ");
  EXPECT_NE(log.find(fmt::format("the ROS master at http://127.0.0.1:{} has not answered within "
                                 "2.4 s: the parameters of /kinescope are not used",
                                 master.port())),
            std::string::npos)
      << log;
  EXPECT_NE(log.find("live: "), std::string::npos) << log;
  bridge.Signal(SIGINT);
  EXPECT_EQ(bridge.WaitForEnd(), 0);
}

// The module's functions are found before those of the ROS libraries that it loads.
TEST_F(LateMaster, WhoseAnswersAreTooDeepIsNotBelieved) {
  const BadMaster master([](int connection, const std::string&) {
    testing::Send(connection, testing::Answer(testing::Nested(40)));
  });
  Process bridge = Start(master, "");
  const std::string log = LogUntil(bridge, "deeper than 32 levels");
  EXPECT_NE(log.find("values nested deeper than 32 levels"), std::string::npos) << log;
  bridge.Signal(SIGINT);
  EXPECT_EQ(bridge.WaitForEnd(), 0);
}

// The first question of each is that for another node of this name.
TEST_F(LateMaster, IsNamedByInspectAndUrdf) {
  const BadMaster master(NeverAnswer);
  const std::string missing = fmt::format(
      "no ROS master answers at http://127.0.0.1:{}: start roscore, or set ROS_MASTER_URI",
      master.port());
  Process inspect = StartProgram(master, "inspect ros: --seconds 0.1");
  Process urdf = StartProgram(master, "urdf ros:");
  const std::string report = LogUntil(inspect, "No person");
  EXPECT_NE(report.find("> " + missing), std::string::npos) << report;
  EXPECT_EQ(inspect.WaitForEnd(), 1);
  const std::string error = LogUntil(urdf, "source 'ros:'");
  EXPECT_NE(error.find("source 'ros:': " + missing), std::string::npos) << error;
  EXPECT_EQ(urdf.WaitForEnd(), 2);
}

// Live sources are refused by their name, without asking it.
TEST_F(LateMaster, IsNotAskedForASourceThatTheCommandCannotRead) {
  std::atomic<bool> is_asked = false;
  const BadMaster master([&](int connection, const std::string& request) {
    is_asked = true;
    NeverAnswer(connection, request);
  });
  Process render = StartProgram(master, "render ros: --time 0 --out unused.png");
  const std::string error = LogUntil(render, "cannot read a live stream");
  EXPECT_NE(error.find("record the stream first (rosbag record -a)"), std::string::npos) << error;
  EXPECT_EQ(render.WaitForEnd(), 2);
  EXPECT_FALSE(is_asked);
}

TEST_F(LateMaster, ThatIsRequiredAndNeverAnswersEndsTheProgram) {
  const BadMaster master(NeverAnswer);
  Process bridge = Start(master, "--ros required");
  const std::string log = LogUntil(bridge, "live: ");
  EXPECT_NE(log.find("--ros=required: no ROS master"), std::string::npos) << log;
  EXPECT_EQ(bridge.WaitForEnd(), 2);
}

}  // namespace
}  // namespace kinescope
