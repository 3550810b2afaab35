// One person among thousands of hostile datagrams a second: a real master, sockets, `kinescope
// serve`, and a subscriber that counts.
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/process.h"
#include "tests/system/ros/ros_fixture.h"
#include "tests/system/run_program.h"

namespace kinescope {
namespace {

using testing::Process;
using testing::RunProgram;

class Flood : public testing::RosProgram {
 protected:
  std::vector<double> stamps_;  // of the honest person's samples, s
};

TEST_F(Flood, LosesNoSampleOfAPersonBesideHostileDatagramsOfEveryKind) {
  if (IsSkipped() || HasFatalFailure()) return;
  constexpr double kRateHz = 240;
  constexpr std::size_t kSamples = 480, kDatagrams = 10'000;
  const auto server =
      Start("serve --source udp://127.0.0.1:0 --http_port 0 --ros required --stale_secs 60");
  const std::string address = WaitForAddress(*server);
  const std::string page = WaitForLine(*server, "page at ");
  Hear<sensor_msgs::JointState>("/kinescope/joint_states", [this](const auto& message) {
    stamps_.push_back(message.header.stamp.toSec());
  });
  const auto suit = Start("stream demo:lift --rate_hz 240 --to " + address);
  ASSERT_TRUE(Spin([this] { return stamps_.size() > 10; }));
  stamps_.clear();
  const std::string port = address.substr(address.rfind(':') + 1);
  const Process hostile({KINESCOPE_HOSTILE_SENDERS, port, "all", "5000", "60"});
  // Those far away are named as long as none of their samples from a possible place is newer.
  nlohmann::json source;
  bool were_named = false;
  ASSERT_TRUE(Spin([&] {
    if (stamps_.size() <= kSamples) return false;
    source = nlohmann::json::parse(
        RunProgram({"/usr/bin/curl", "-sf", page + "api/v1/diagnostics"}).out)["source"];
    were_named = were_named || !source.at("left_out").empty();
    return were_named && source.at("datagrams").get<std::size_t>() > kDatagrams;
  })) << source;
  const std::size_t drops = source.at("transport").value("kernel_drops", std::size_t{0});
  std::size_t missing = 0;
  for (std::size_t i = 1; i < stamps_.size(); ++i) {
    const double periods = (stamps_[i] - stamps_[i - 1]) * kRateHz;
    EXPECT_GT(periods, 0.2) << "a sample came twice";
    missing += periods > 1.5 ? static_cast<std::size_t>(periods - 0.5) : 0;
  }
  EXPECT_LE(missing, drops) << "what was lost is counted";
}

}  // namespace
}  // namespace kinescope
