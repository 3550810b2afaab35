// One person among thousands of hostile datagrams a second, and beside large clouds: a real master,
// sockets, `kinescope serve`, and a subscriber that counts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/String.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/folders.h"
#include "tests/process.h"
#include "tests/system/process_memory.h"
#include "tests/system/ros/ros_fixture.h"
#include "tests/system/run_program.h"

namespace kinescope {
namespace {

using ::testing::Each;
using testing::MegabytesOf;
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
  const Process hostile({kinescope::testing::InBuild("tests/soak/hostile_senders").string(), port,
                         "all", "5000", "60"});
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

sensor_msgs::PointCloud2 CloudOf(std::uint32_t points) {
  sensor_msgs::PointCloud2 cloud;
  cloud.header.frame_id = "world";
  cloud.height = 1;
  cloud.width = points;
  for (std::uint32_t i = 0; i < 3; ++i) {
    sensor_msgs::PointField field;
    field.name = std::string(1, "xyz"[i]);
    field.offset = 4 * i;
    field.datatype = sensor_msgs::PointField::FLOAT32;
    field.count = 1;
    cloud.fields.push_back(field);
  }
  cloud.point_step = 12;
  cloud.row_step = cloud.point_step * points;
  cloud.data.resize(cloud.row_step);
  return cloud;
}

// A depth camera of two million points, as fast as it can: the newest clouds are shown, in bounded
// memory, and one that is too large is left out alone. Nobody is stale meanwhile.
TEST_F(Flood, OfLargeCloudsKeepsNoPersonWaiting) {
  if (IsSkipped() || HasFatalFailure()) return;
  ros::Publisher clouds = node_->advertise<sensor_msgs::PointCloud2>("/cloud", 1);
  std::vector<std::string> states;
  Hear<std_msgs::String>("/kinescope/state",
                         [&](const auto& message) { states.push_back(message.data); });
  std::size_t samples = 0;
  Hear<sensor_msgs::JointState>("/kinescope/joint_states", [&](const auto&) { ++samples; });
  const auto server =
      Start("serve demo:lift --http_port 0 --ros required --pictures off --marker_topics /cloud");
  const std::string page = WaitForLine(*server, "page at ");
  ASSERT_TRUE(Spin([&] { return samples > 100 && clouds.getNumSubscribers() > 0; }));
  const sensor_msgs::PointCloud2 cloud = CloudOf(2'000'000), beyond = CloudOf(6'000'000);
  states.clear();
  samples = 0;
  nlohmann::json ros;
  const auto input = [&] { return ros["inputs"]["/cloud"]; };
  clouds.publish(beyond);
  ASSERT_TRUE(Spin([&] {
    clouds.publish(cloud);
    if (samples < 480) return false;
    ros = nlohmann::json::parse(
        RunProgram({"/usr/bin/curl", "-sf", page + "api/v1/diagnostics"}).out)["ros"];
    return input()["used"] >= 10 && !ros["rejected_calls"].empty();
  })) << ros;
  EXPECT_THAT(states, Each("live"));
  EXPECT_LT(MegabytesOf(server->pid(), "VmHWM:"), 1000) << "MB";
}

}  // namespace
}  // namespace kinescope
