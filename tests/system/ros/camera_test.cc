// Pictures of a camera of another node: in the server's picture, on the page, and of a bag in a
// rendered picture; with a real master.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "render/image/png_file.h"
#include "tests/server/http/test_client.h"
#include "tests/system/ros/ros_fixture.h"
#include "tests/system/run_program.h"

namespace kinescope {
namespace {

using http::testing::Fetch;
using ::testing::HasSubstr;
using testing::RunProgram;

constexpr char kTopic[] = "/lab/image_raw";

sensor_msgs::Image Magenta() {
  sensor_msgs::Image message;
  message.width = 160;
  message.height = 120;
  message.encoding = "rgb8";
  message.step = 3 * message.width;
  message.data.resize(std::size_t{message.step} * message.height);
  for (std::size_t i = 0; i < message.data.size(); ++i) message.data[i] = i % 3 == 1 ? 0 : 255;
  return message;
}

// Of a camera that sees 1.6 m of height 2 m ahead.
sensor_msgs::CameraInfo InfoOfMagenta() {
  sensor_msgs::CameraInfo info;
  info.width = 160;
  info.height = 120;
  info.P = {150, 0, 79.5, 0, 0, 150, 59.5, 0, 0, 0, 1, 0};
  return info;
}

// 2 m before the person, who is at the origin, and 1 m high; z towards the person, y down.
tf2_msgs::TFMessage InFrontOfPerson() {
  tf2_msgs::TFMessage message;
  message.transforms.resize(1);
  auto& transform = message.transforms.front();
  transform.header.frame_id = "world";
  transform.child_frame_id = "eye";
  transform.transform.translation.x = 2;
  transform.transform.translation.z = 1;
  transform.transform.rotation.x = transform.transform.rotation.y = -0.5;
  transform.transform.rotation.z = transform.transform.rotation.w = 0.5;
  return message;
}

struct Box {
  int left = 1 << 20, top = 1 << 20, right = -1, bottom = -1, pixels = 0;
};

// Of what nothing else in a picture looks like.
Box MagentaIn(const render::Image& image) {
  Box box;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* const pixel =
          &image.rgba[4 * static_cast<std::size_t>(y * image.width + x)];
      if (pixel[0] < 250 || pixel[1] > 5 || pixel[2] < 250) continue;
      box = {std::min(box.left, x), std::min(box.top, y), std::max(box.right, x),
             std::max(box.bottom, y), box.pixels + 1};
    }
  }
  return box;
}

// 4 : 3, above the time code.
void ExpectAtTheRightEdge(const Box& box) {
  EXPECT_NEAR(box.right, 1260, 2);
  EXPECT_GT(box.bottom, 600);
  EXPECT_LT(box.bottom, 680);
  const int width = box.right - box.left + 1, height = box.bottom - box.top + 1;
  EXPECT_NEAR(width, 0.22 * 1280, 2);
  EXPECT_NEAR(height, 0.75 * width, 2);
  EXPECT_GT(box.pixels, 0.8 * width * height) << "but for its name";
}

class CameraOverRos : public testing::RosProgram {
 protected:
  render::Image FileOf(const std::string& name, const std::string& bytes) const {
    const std::filesystem::path path = folder_ / name;
    std::ofstream(path, std::ios::binary) << bytes;
    return render::ReadPng(path);
  }
};

TEST_F(CameraOverRos, IsAPictureInThePictureAndOnThePage) {
  setenv("XDG_STATE_HOME", folder_.path().c_str(), 1);
  const auto program = Start("serve demo:n_pose --ros required --http_port 0 --marker_topics " +
                             std::string(kTopic));
  const std::string url = WaitForLine(*program, "page at ");
  const int port = std::stoi(url.substr(url.rfind(':') + 1));
  EXPECT_EQ(Fetch(port, "/api/v1/image/0").status, 404);
  ros::Publisher camera = node_->advertise<sensor_msgs::Image>(kTopic, 1);
  ASSERT_TRUE(Spin([&] {
    camera.publish(Magenta());
    return Fetch(port, "/api/v1/image/0").status == 200;
  }));
  const auto file = Fetch(port, "/api/v1/image/0");
  const auto pixels = render::ReadJpeg(reinterpret_cast<const std::uint8_t*>(file.body.data()),
                                       file.body.size(), 1000);
  EXPECT_EQ(pixels.width, 160);
  EXPECT_EQ(pixels.height, 120);
  const auto snapshot = FileOf("live.png", Fetch(port, "/api/v1/snapshot.png").body);
  ExpectAtTheRightEdge(MagentaIn(snapshot));

  sensor_msgs::Image lying = Magenta();
  lying.height = 1000;
  camera.publish(lying);
  std::string counters;
  EXPECT_TRUE(Spin([&] {
    counters = Fetch(port, "/api/v1/diagnostics").json()["ros"]["inputs"][kTopic].dump();
    return counters.find("states more pixels") != std::string::npos;
  })) << counters;
  EXPECT_EQ(Fetch(port, "/api/v1/image/0").status, 200) << "the last good one stays";
}

TEST_F(CameraOverRos, HasTheSceneOverItsPictureWhereItIsCalibrated) {
  setenv("XDG_STATE_HOME", folder_.path().c_str(), 1);
  const auto program = Start("serve demo:n_pose --ros required --http_port 0 --marker_topics '" +
                             std::string(kTopic) + "(scene=1)'");
  const std::string url = WaitForLine(*program, "page at ");
  const int port = std::stoi(url.substr(url.rfind(':') + 1));
  ros::Publisher camera = node_->advertise<sensor_msgs::Image>(kTopic, 1);
  ros::Publisher calibration = node_->advertise<sensor_msgs::CameraInfo>("/lab/camera_info", 1);
  ros::Publisher frames = node_->advertise<tf2_msgs::TFMessage>("/tf_static", 1, true);
  sensor_msgs::Image image = Magenta();
  image.header.frame_id = "eye";
  const auto publish = [&] {
    image.header.stamp = ros::Time::now();
    sensor_msgs::CameraInfo info = InfoOfMagenta();
    info.header = image.header;
    calibration.publish(info);
    camera.publish(image);
  };
  std::string said;
  EXPECT_TRUE(Spin([&] {
    publish();
    said = Fetch(port, "/api/v1/diagnostics").json()["ros"]["inputs"][kTopic].dump();
    return said.find("the scene is not drawn over its pictures: frame 'eye' is not known yet") !=
           std::string::npos;
  })) << said;
  // How much of the magenta is hidden: by its name, and by the person before the camera.
  const auto hidden = [&]() -> std::optional<double> {
    publish();
    const auto snapshot = Fetch(port, "/api/v1/snapshot.png");
    if (snapshot.status != 200) return std::nullopt;  // too soon after the one before
    const Box box = MagentaIn(FileOf("live.png", snapshot.body));
    return 1 - box.pixels / (1.0 * (box.right - box.left + 1) * (box.bottom - box.top + 1));
  };
  std::optional<double> by_name, by_both;
  EXPECT_TRUE(Spin([&] { return (by_name = hidden()).has_value(); }));
  frames.publish(InFrontOfPerson());
  EXPECT_TRUE(Spin([&] {
    by_both = hidden();
    return by_both && *by_both > *by_name + 0.07;
  })) << by_both.value_or(0);
  EXPECT_LT(by_both.value_or(1), 0.7);
}

TEST_F(CameraOverRos, IsDrawnOfABag) {
  const std::string path = folder_ / "lab.bag";
  // A person as the bridge publishes it, which a listener records with its pictures.
  {
    rosbag::Bag bag(path, rosbag::bagmode::Write);
    int samples = 0;
    Hear<tf2_msgs::TFMessage>("/tf", [&](const tf2_msgs::TFMessage& message) {
      const ros::Time now = message.transforms.front().header.stamp;
      bag.write("/tf", now, message);
      if (samples++ == 10) bag.write(kTopic, now, Magenta());
    });
    const auto program = Start("bridge demo:n_pose --ros required");
    ASSERT_TRUE(Spin([&] { return samples > 60; }));
  }
  const std::string program = testing::KinescopePath();
  const auto draw = [&](const std::string& name, const std::vector<std::string>& options) {
    std::vector<std::string> command = {
        program, "render", path, "--time", "0.4", "--out", (folder_ / name).string()};
    command.insert(command.end(), options.begin(), options.end());
    const auto result = RunProgram(command);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return MagentaIn(render::ReadPng(folder_ / name));
  };
  ExpectAtTheRightEdge(draw("with.png", {"--marker_topics", kTopic}));
  EXPECT_EQ(draw("without.png", {"--marker_topics", kTopic, "--overlay=-images"}).pixels, 0);
}

}  // namespace
}  // namespace kinescope
