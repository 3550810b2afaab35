// A graph of robots alone, and its bag: seen by a server and in rendered pictures, with a real
// master, until a person comes.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/Marker.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "render/image/png_file.h"
#include "tests/server/http/test_client.h"
#include "tests/system/ros/ros_fixture.h"
#include "tests/system/run_program.h"

namespace kinescope {
namespace {

using http::testing::Fetch;
using ::testing::HasSubstr;
using testing::ProgramResult;
using testing::RunProgram;
using visualization_msgs::Marker;

// Of a robot far from the origin.
tf2_msgs::TFMessage FrameOfRobot(const ros::Time& stamp) {
  tf2_msgs::TFMessage message;
  message.transforms.resize(1);
  message.transforms[0].header.stamp = stamp;
  message.transforms[0].header.frame_id = "map";
  message.transforms[0].child_frame_id = "base_link";
  message.transforms[0].transform.translation.x = 40;
  message.transforms[0].transform.rotation.w = 1;
  return message;
}

Marker MagentaBall(const ros::Time& stamp) {
  Marker marker;
  marker.header.frame_id = "base_link";
  marker.header.stamp = stamp;
  marker.ns = "goal";
  marker.type = Marker::SPHERE;
  marker.pose.position.z = 0.8;
  marker.pose.orientation.w = 1;
  marker.scale.x = marker.scale.y = marker.scale.z = 0.5;
  marker.color.r = marker.color.b = marker.color.a = 1;
  return marker;
}

// Share of the picture.
double Magenta(const std::filesystem::path& png) {
  const render::Image image = render::ReadPng(png);
  std::size_t count = 0;
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    const bool is_it = image.rgba[i] > 90 && image.rgba[i + 1] < 60 && image.rgba[i + 2] > 90;
    count += is_it ? 1 : 0;
  }
  return 4.0 * static_cast<double>(count) / static_cast<double>(image.rgba.size());
}

class WithoutAPerson : public testing::RosProgram {
 protected:
  void SetUp() override {
    RosProgram::SetUp();
    setenv("XDG_STATE_HOME", folder_.path().c_str(), 1);
    std::ofstream(folder_ / "robot.urdf")
        << "<robot name='cart'><link name='base_link'><visual><geometry><box size='1 1 0.4'/>"
           "</geometry></visual></link></robot>";
  }
  std::string Robot() const { return "--robot=" + (folder_ / "robot.urdf").string() + "@tf"; }
};

TEST_F(WithoutAPerson, AServerShowsTheGraphUntilOneComes) {
  ros::Publisher frames = node_->advertise<tf2_msgs::TFMessage>("/tf", 10);
  ros::Publisher markers = node_->advertise<Marker>("/goal", 10);
  const auto program =
      Start("serve ros: __name:=view --http_port 0 --marker_topics /goal " + Robot());
  const std::string url = WaitForLine(*program, "page at ");
  const int port = std::stoi(url.substr(url.rfind(':') + 1));
  const auto liveness = [&] { return Fetch(port, "/api/v1/state").json()["liveness"]; };
  EXPECT_EQ(liveness(), "no data");
  const auto publish = [&] {
    frames.publish(FrameOfRobot(ros::Time::now()));
    markers.publish(MagentaBall(ros::Time::now()));
  };
  ASSERT_TRUE(Spin([&] {
    publish();
    return liveness() == "no person";
  }));
  const auto frame = [&] { return Fetch(port, "/api/v1/diagnostics").json()["ros"]["frame"]; };
  EXPECT_TRUE(Spin([&] { return frame() == "map"; })) << frame();
  std::filesystem::path png = folder_ / "live.png";
  EXPECT_TRUE(Spin([&] {
    publish();
    const auto snapshot = Fetch(port, "/api/v1/snapshot.png");
    if (snapshot.status != 200) return false;  // it may be busy with the one before
    std::ofstream(png) << snapshot.body;
    return Magenta(png) > 0.004;
  })) << "the camera looks at the robot";
  EXPECT_TRUE(Spin([&] { return liveness() == "stale"; })) << "no frame comes any more";

  const auto human = Start("bridge demo:walk __name:=human --ros required");
  EXPECT_TRUE(Spin([&] { return liveness() == "live"; }));
  EXPECT_EQ(Fetch(port, "/api/v1/state").json()["people"].size(), 1u);
  EXPECT_TRUE(Spin([&] { return frame() == "world"; })) << frame();
}

TEST_F(WithoutAPerson, ABagIsDrawnAndPlayed) {
  const std::string path = folder_ / "robot.bag";
  {
    rosbag::Bag bag(path, rosbag::bagmode::Write);
    for (int i = 0; i < 20; ++i) {
      const ros::Time now(1000 + 0.1 * i);
      bag.write("/tf", now, FrameOfRobot(now));
      bag.write("/goal", now, MagentaBall(now));
    }
  }
  const std::string png = folder_ / "bag.png";
  const ProgramResult drawn =
      RunProgram({testing::KinescopePath(), "render", path, "--time=1", Robot(), "--out", png});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_GT(Magenta(png), 0.004);
  const ProgramResult late =
      RunProgram({testing::KinescopePath(), "render", path, "--time=9", "--out", png});
  EXPECT_THAT(late.err, HasSubstr("ends before this time, at 1.9"));
  const std::string clip = folder_ / "bag.mp4";
  const ProgramResult filmed = RunProgram(
      {testing::KinescopePath(), "render", path, "--fps=10", "--size=320x180", "--out", clip});
  EXPECT_EQ(filmed.exit_code, 0) << filmed.err;
  EXPECT_THAT(filmed.out, HasSubstr("20 pictures"));
  for (const char* command : {"loads", "urdf"}) {
    const ProgramResult refused = RunProgram({testing::KinescopePath(), command, path});
    EXPECT_NE(refused.exit_code, 0);
    EXPECT_THAT(refused.err, HasSubstr("no person found on /tf")) << command;
  }
  const auto program = Start("serve '" + path + "' --loop --http_port 0 --ros off " + Robot());
  const std::string url = WaitForLine(*program, "page at ");
  const int port = std::stoi(url.substr(url.rfind(':') + 1));
  EXPECT_TRUE(Spin([&] {
    const auto state = Fetch(port, "/api/v1/state").json();
    return state["liveness"] == "no person" && state["time_code_millis"] > 2500;
  })) << "in the second round";
}

TEST_F(WithoutAPerson, ABagGoesOnWhenThePersonHasLeft) {
  std::vector<tf2_msgs::TFMessage> frames;
  {
    const boost::function<void(const tf2_msgs::TFMessage&)> take =
        [&](const tf2_msgs::TFMessage& message) { frames.push_back(message); };
    const ros::Subscriber subscriber = node_->subscribe<tf2_msgs::TFMessage>("/tf", 100, take);
    const auto human = Start("bridge demo:walk --ros required");
    ASSERT_TRUE(Spin([&] { return frames.size() >= 60; }));
  }
  const std::string path = folder_ / "left.bag";
  const ros::Time begin = frames.front().transforms.front().header.stamp,
                  end = frames.back().transforms.front().header.stamp;
  {
    rosbag::Bag bag(path, rosbag::bagmode::Write);
    ros::Time now;
    for (const tf2_msgs::TFMessage& each : frames) {
      now = each.transforms.front().header.stamp;
      bag.write("/tf", now, each);
    }
    for (int i = 0; i < 30; ++i) {
      now += ros::Duration(0.1);
      Marker ball = MagentaBall(now);
      ball.header.frame_id = "world";
      bag.write("/goal", now, ball);
    }
  }
  const std::string png = folder_ / "left.png";
  const ProgramResult drawn = RunProgram({testing::KinescopePath(), "render", path, "--time=3",
                                          "--marker_topics=/goal", "--out", png});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_GT(Magenta(png), 0.0005);
  const double secs = (end - begin).toSec();
  const ProgramResult stale =
      RunProgram({testing::KinescopePath(), "render", path, "--marker_topics=/goal",
                  fmt::format("--time={:.3f}", secs + 0.75), "--overlay_layer=pdf", "--out",
                  folder_ / "stale.png"});
  ASSERT_EQ(stale.exit_code, 0) << stale.err;
  EXPECT_THAT(RunProgram({"/usr/bin/pdftotext", folder_ / "stale.pdf", "-"}).out,
              HasSubstr(fmt::format("STALE – last sample 00:00:{:06.3f}", secs)));
  const ProgramResult filmed =
      RunProgram({testing::KinescopePath(), "render", path, "--marker_topics=/goal", "--fps=10",
                  "--size=320x180", "--out", folder_ / "left.mp4"});
  EXPECT_EQ(filmed.exit_code, 0) << filmed.err;
  EXPECT_GE(std::stoi(filmed.out.substr(filmed.out.find(": ") + 2)), 30) << filmed.out;
}

}  // namespace
}  // namespace kinescope
