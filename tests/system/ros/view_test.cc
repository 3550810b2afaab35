// What ROS sees of the person, with everything real: a master, `kinescope serve`, and this test as
// the one who looks.
#include <geometry_msgs/PointStamped.h>
#include <gtest/gtest.h>
#include <image_transport/image_transport.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <signal.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/Marker.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "render/renderer.h"
#include "tests/folders.h"
#include "tests/server/http/test_client.h"
#include "tests/system/ros/ros_fixture.h"

namespace kinescope {
namespace {

using http::testing::Fetch;

constexpr int kViewWidth = 320, kViewHeight = 240;
constexpr char kFrame[] = "kinescope_view_camera_optical";

Eigen::Isometry3d ToEigen(const geometry_msgs::Transform& transform) {
  const auto& p = transform.translation;
  const auto& q = transform.rotation;
  return Eigen::Translation3d(p.x, p.y, p.z) * Eigen::Quaterniond(q.w, q.x, q.y, q.z);
}

class ViewOverRos : public testing::RosProgram {
 protected:
  void StartServe(const std::string& options) {
    program_ = Start("serve --ros required --http_port 0 --source demo:t_pose " + options);
    const std::string url = WaitForLine(*program_, "page at ");
    const std::size_t colon = url.rfind(':');
    ASSERT_NE(colon, std::string::npos) << url;
    port_ = std::stoi(url.substr(colon + 1));
  }
  nlohmann::json Diagnostics(const std::string& part) const {
    return Fetch(port_, "/api/v1/diagnostics").json().at(part);
  }

  // Frames by stamp, as they come.
  void HearFrames() {
    Hear<tf2_msgs::TFMessage>("/tf", [this](const tf2_msgs::TFMessage& message) {
      for (const auto& transform : message.transforms) {
        EXPECT_EQ(transform.header.frame_id, "world");
        frames_[transform.header.stamp][transform.child_frame_id] = ToEigen(transform.transform);
      }
    });
  }

  // Asks about the publishers: what the master knows of a topic.
  static bool IsAdvertised(const std::string& topic) {
    ros::master::V_TopicInfo topics;
    ros::master::getTopics(topics);
    for (const auto& info : topics) {
      if (info.name == topic) return true;
    }
    return false;
  }

  std::unique_ptr<testing::Process> program_;
  int port_ = 0;
  std::map<ros::Time, std::map<std::string, Eigen::Isometry3d>> frames_;
};

// The picture of an empty floor, by the camera that the messages describe.
render::Image FloorAlone(const Eigen::Isometry3d& world_from_optical,
                         const sensor_msgs::CameraInfo& info) {
  render::Camera camera;
  camera.position = world_from_optical.translation();
  camera.target = camera.position + world_from_optical.linear().col(2);
  camera.up = -world_from_optical.linear().col(1);
  camera.vertical_fov_rad = 2 * std::atan(0.5 * info.height / info.K[4]);
  SceneState nobody;
  nobody.liveness = Liveness::kLive;
  return render::MakeRenderer()->Render(nobody, camera, {kViewWidth, kViewHeight, 1, "", false});
}

TEST_F(ViewOverRos, ShowsEveryLinkAtItsFrameAccordingToTheCalibration) {
  StartServe("--ros_view_size 320x240 --ros_view_rate_hz 10 --ros_view_camera iso");
  HearFrames();
  EXPECT_EQ(Diagnostics("view").at("drawn"), 0) << "nobody listens";
  sensor_msgs::Image image;
  std::map<ros::Time, sensor_msgs::CameraInfo> infos;
  Hear<sensor_msgs::CameraInfo>("/kinescope/view/camera_info",
                                [&](const auto& m) { infos[m.header.stamp] = m; });
  Hear<sensor_msgs::Image>("/kinescope/view/image_raw", [&](const auto& m) { image = m; });
  const auto is_whole = [&] {
    const ros::Time& stamp = image.header.stamp;
    return !stamp.isZero() && infos.count(stamp) > 0 && frames_[stamp].count(kFrame) > 0 &&
           frames_[stamp].count("skeleton_head") > 0;
  };
  ASSERT_TRUE(Spin(is_whole)) << "picture, camera_info and frames of one stamp";
  const auto& frames = frames_.at(image.header.stamp);
  const sensor_msgs::CameraInfo& info = infos.at(image.header.stamp);
  EXPECT_EQ(image.header.frame_id, kFrame);
  EXPECT_EQ(info.header.frame_id, kFrame);
  ASSERT_EQ(image.width, static_cast<std::uint32_t>(kViewWidth));
  ASSERT_EQ(image.height, static_cast<std::uint32_t>(kViewHeight));
  EXPECT_EQ(info.width, image.width);
  const Eigen::Isometry3d& world_from_optical = frames.at(kFrame);
  const render::Image floor = FloorAlone(world_from_optical, info);
  const auto shows_person = [&](const Eigen::Vector3d& world) {
    const Eigen::Vector3d seen = world_from_optical.inverse() * world;
    const long u = std::lround(info.P[0] * seen.x() / seen.z() + info.P[2]);
    const long v = std::lround(info.P[5] * seen.y() / seen.z() + info.P[6]);
    if (u < 0 || v < 0 || u >= kViewWidth || v >= kViewHeight) return false;
    const auto pixel = static_cast<std::size_t>(v * kViewWidth + u);
    int difference = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      difference += std::abs(image.data[3 * pixel + k] - floor.rgba[4 * pixel + k]);
    }
    return difference > 30;
  };
  int links = 0;
  for (const auto& [name, world_from_link] : frames) {
    if (name.rfind("skeleton_", 0) != 0 || name.find("_link") != std::string::npos) continue;
    ++links;
    if (name.find("_toe") != std::string::npos) continue;  // lit, it is as light as the floor
    EXPECT_TRUE(shows_person(world_from_link.translation())) << name;
  }
  EXPECT_EQ(links, 23);
  // Half a hand's breadth beside a wrist, above and below the arm that is held out.
  for (const double up : {-0.12, 0.12}) {
    const Eigen::Vector3d beside =
        frames.at("skeleton_right_hand").translation() + Eigen::Vector3d(0, 0, up);
    EXPECT_FALSE(shows_person(beside)) << up;
  }
}

TEST_F(ViewOverRos, IsRenderedAtItsRateOnlyWhileItHasSubscribers) {
  int images = 0;
  Hear<sensor_msgs::Image>("/kinescope/view/image_raw", [&](const auto&) { ++images; });
  StartServe("--ros_view_size 64x48 --ros_view_rate_hz 5");  // somebody waits for it already
  ASSERT_TRUE(Spin([&] { return images > 0; }));
  const auto drawn_now = [&] { return Diagnostics("view").at("drawn").get<int>(); };
  const auto before = Clock::now();
  const int first = drawn_now();
  ASSERT_TRUE(Spin([&] { return drawn_now() >= first + 6; }));
  // Samples come at 120 Hz, pictures are at least 0.2 s apart; both counts may be read late.
  EXPECT_GE(Clock::now() - before, std::chrono::milliseconds(600));
  EXPECT_EQ(Diagnostics("view").at("listeners"), 1);
  subscribers_.clear();
  ASSERT_TRUE(Spin([&] { return Diagnostics("view").at("listeners") == 0; }));
  const int drawn = drawn_now();
  const auto state = Fetch(port_, "/api/v1/state").json();
  // More samples have come, and no picture of them.
  ASSERT_TRUE(Spin([&] {
    return Fetch(port_, "/api/v1/state").json().at("counter").get<int>() >
           state.at("counter").get<int>() + 100;
  }));
  EXPECT_LE(drawn_now(), drawn + 1) << "one was in hand";
}

// A wall that another program shows is in the picture, where it says it is and in its colour.
TEST_F(ViewOverRos, ShowsExternalMarkers) {
  StartServe(
      "--ros_view_size 320x240 --ros_view_rate_hz 10 --ros_view_camera front --marker_topics "
      "/walls");
  HearFrames();
  visualization_msgs::Marker wall;
  wall.header.frame_id = "world";
  wall.type = visualization_msgs::Marker::CUBE;
  wall.pose.position.y = 0.9;
  wall.pose.position.z = 0.4;
  wall.scale.x = wall.scale.y = wall.scale.z = 0.3;
  wall.color.r = wall.color.a = 1;
  const ros::Publisher walls = node_->advertise<visualization_msgs::Marker>("/walls", 1, true);
  walls.publish(wall);
  sensor_msgs::Image image;
  std::map<ros::Time, sensor_msgs::CameraInfo> infos;
  Hear<sensor_msgs::CameraInfo>("/kinescope/view/camera_info",
                                [&](const auto& m) { infos[m.header.stamp] = m; });
  Hear<sensor_msgs::Image>("/kinescope/view/image_raw", [&](const auto& m) { image = m; });
  const Eigen::Vector3d middle(0, wall.pose.position.y, wall.pose.position.z);
  const auto is_red = [&] {
    const ros::Time& stamp = image.header.stamp;
    if (infos.count(stamp) == 0 || frames_[stamp].count(kFrame) == 0) return false;
    const sensor_msgs::CameraInfo& info = infos.at(stamp);
    const Eigen::Vector3d seen = frames_[stamp].at(kFrame).inverse() * middle;
    const long u = std::lround(info.P[0] * seen.x() / seen.z() + info.P[2]);
    const long v = std::lround(info.P[5] * seen.y() / seen.z() + info.P[6]);
    const auto* pixel = &image.data.at(3 * static_cast<std::size_t>(v * kViewWidth + u));
    return pixel[0] > 120 && pixel[1] < 60 && pixel[2] < 60;
  };
  EXPECT_TRUE(Spin(is_red)) << Diagnostics("ros");
}

// What RViz has a display for: a point is a sphere in its colour, where it says it is.
TEST_F(ViewOverRos, ShowsPointsOfOtherNodes) {
  StartServe(
      "--ros_view_size 320x240 --ros_view_rate_hz 10 --ros_view_camera front --marker_topics "
      "/goal");
  geometry_msgs::PointStamped goal;
  goal.header.frame_id = "world";
  goal.point.y = 0.9;
  goal.point.z = 0.4;
  const ros::Publisher goals = node_->advertise<geometry_msgs::PointStamped>("/goal", 1, true);
  goals.publish(goal);
  sensor_msgs::Image image;
  Hear<sensor_msgs::Image>("/kinescope/view/image_raw", [&](const auto& m) { image = m; });
  const auto has_goal = [&] {
    std::size_t magenta = 0;
    for (std::size_t i = 0; i + 2 < image.data.size(); i += 3) {
      magenta += image.data[i] > 120 && image.data[i + 1] < 70 && image.data[i + 2] > 120;
    }
    return magenta > 200;
  };
  EXPECT_TRUE(Spin(has_goal)) << Diagnostics("ros");
}

TEST_F(ViewOverRos, ArrivesThroughEveryInstalledTransport) {
  StartServe("--ros_view_size 64x48 --ros_view_rate_hz 10");
  image_transport::ImageTransport transport(*node_);
  std::string installed;
  for (const std::string& name : transport.getLoadableTransports()) installed += name + " ";
  RecordProperty("transports", installed);
  for (const std::string wanted : {"raw", "compressed"}) {
    if (installed.find("/" + wanted + " ") == std::string::npos) continue;
    sensor_msgs::ImageConstPtr image;
    const auto subscriber = transport.subscribe(
        "/kinescope/view/image_raw", 1,
        [&](const sensor_msgs::ImageConstPtr& message) { image = message; }, ros::VoidPtr(),
        image_transport::TransportHints(wanted));
    EXPECT_TRUE(Spin([&] { return image && image->width == 64; })) << wanted;
  }
  EXPECT_NE(installed.find("/raw "), std::string::npos) << installed;
}

TEST_F(ViewOverRos, IsAdvertisedAgainAfterARestartOfTheMaster) {
  StartServe("--ros_view_size 64x48 --ros_view_rate_hz 10");
  master_.reset();
  StartMaster();
  ASSERT_TRUE(Spin([] { return IsAdvertised("/kinescope/view/image_raw"); }));
  bool has_image = false;
  Hear<sensor_msgs::Image>("/kinescope/view/image_raw", [&](const auto&) { has_image = true; });
  EXPECT_TRUE(Spin([&] { return has_image; }));
}

TEST_F(ViewOverRos, IsNotAdvertisedIfItOrPicturesAreOff) {
  StartServe("--pictures off");
  ASSERT_TRUE(Spin([] { return IsAdvertised("/kinescope/joint_states"); }));
  EXPECT_FALSE(IsAdvertised("/kinescope/view/image_raw"));
  EXPECT_TRUE(Diagnostics("view").is_null());
  program_.reset();
  StartServe("--ros_view off --pictures on");
  ASSERT_TRUE(Spin([] { return IsAdvertised("/kinescope/joint_states"); }));
  EXPECT_FALSE(IsAdvertised("/kinescope/view/image_raw"));
}

TEST_F(ViewOverRos, AllowsTheProgramToStopIfItsDriverDoesNotRespond) {
  const std::filesystem::path hang = folder_ / "hang";
  bool has_image = false;
  Hear<sensor_msgs::Image>("/kinescope/view/image_raw", [&](const auto&) { has_image = true; });
  // The limit is what the first picture may take on a busy machine; the test waits for it once.
  setenv("HANGING_DRIVER_FILE", hang.c_str(), 1);
  setenv("LD_PRELOAD", kinescope::testing::InBuild("tests/system/libhanging_driver.so").c_str(), 1);
  StartServe("--ros_view_size 64x48 --picture_size 64x48 --draw_limit_secs 3");
  unsetenv("LD_PRELOAD");
  const auto hangs = [&] { return Diagnostics("view").at("driver_hung").get<bool>(); };
  ASSERT_TRUE(Spin([&] { return has_image && !hangs(); }));
  std::ofstream(hang).flush();
  ASSERT_TRUE(Spin(hangs));
  EXPECT_NE(Diagnostics("view").at("last_error").get<std::string>().find("does not respond"),
            std::string::npos);
  EXPECT_FALSE(Diagnostics("pictures").at("driver_hung").get<bool>()) << "nobody looks at the page";
  program_->Signal(SIGTERM);
  EXPECT_NE(WaitForLine(*program_, "kinescope: stopped without a clean shutdown: ")
                .find("does not respond"),
            std::string::npos);
}

}  // namespace
}  // namespace kinescope
