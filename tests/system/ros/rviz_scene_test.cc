// A scene of a lab, shown by RViz and by `kinescope serve --rviz` with the configuration that RViz
// has saved: a robot that TF moves, point clouds, a path, a force, a value, a marker and the
// person, from a camera that goes with a frame; and the effort of a joint as a ring.
#include <fmt/ranges.h>
#include <geometry_msgs/PoseArray.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>
#include <interactive_markers/interactive_marker_server.h>
#include <nav_msgs/Path.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/Temperature.h>
#include <std_msgs/Bool.h>
#include <std_msgs/String.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/Marker.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <regex>
#include <string>
#include <vector>

#include "tests/folders.h"
#include "tests/shared_data.h"
#include "tests/system/kinescope_path.h"
#include "tests/system/ros/rviz_fixture.h"

namespace kinescope {
namespace {

using testing::Process;

constexpr char kArmOfScene[] =
    "<robot name='arm'><link name='base'><visual><origin xyz='0 0 0.25'/><geometry>"
    "<cylinder radius='0.12' length='0.5'/></geometry><material name='b'>"
    "<color rgba='0.1 0.25 0.9 1'/></material></visual></link>"
    "<link name='hand'><visual><origin xyz='0.3 0 0'/><geometry><box size='0.6 0.12 0.12'/>"
    "</geometry><material name='y'><color rgba='0.9 0.8 0.05 1'/></material></visual></link>"
    "<joint name='lift' type='revolute'><parent link='base'/><child link='hand'/>"
    "<origin xyz='0 0 0.55'/><axis xyz='0 -1 0'/><limit lower='-2' upper='2' effort='1' "
    "velocity='1'/></joint></robot>";

constexpr char kPersonOfConfig[] = R"(Panels: []
Visualization Manager:
  Class: ""
  Displays:
    - {Class: rviz/RobotModel, Name: Person, Enabled: true, Value: true, Alpha: 1,
       Robot Description: human_description, Visual Enabled: true, Collision Enabled: false}
    - {Class: rviz/MarkerArray, Name: Loads, Enabled: true, Value: true,
       Marker Topic: /kinescope/markers, Namespaces: {}}
)";

constexpr char kThingsOfConfig[] =
    R"(    - {Class: rviz/RobotModel, Name: Arm, Enabled: true, Value: true, Alpha: 1,
       Robot Description: robot_description, Visual Enabled: true, Collision Enabled: false}
    - {Class: rviz/PointCloud2, Name: Cloud, Enabled: true, Value: true, Topic: /cloud, Alpha: 1,
       Style: Boxes, Size (m): 0.03, Color Transformer: FlatColor, Color: 230; 30; 220}
    - {Class: rviz/PointCloud2, Name: Heights, Enabled: true, Value: true, Topic: /heights, Alpha: 1,
       Style: Points, Size (Pixels): 4, Color Transformer: AxisColor, Axis: Z, Use Fixed Frame: true,
       Autocompute Value Bounds: {Max Value: 5.6, Min Value: -4.4, Value: false}}
    - {Class: rviz/Temperature, Name: Effort, Enabled: true, Value: true, Topic: /effort, Alpha: 1,
       Style: Spheres, Size (m): 0.3, Color Transformer: Intensity, Channel Name: temperature,
       Use rainbow: false, Invert Rainbow: true, Autocompute Intensity Bounds: false,
       Min Intensity: 0, Max Intensity: 90, Min Color: 255; 0; 0, Max Color: 255; 0; 200}
    - {Class: rviz/WrenchStamped, Name: Push, Enabled: true, Value: true, Topic: /push, Alpha: 1,
       Force Color: 255; 140; 0, Force Arrow Scale: 0.005, Torque Arrow Scale: 0, Arrow Width: 0.6,
       Hide Small Values: true}
    - {Class: rviz/Path, Name: Plan, Enabled: true, Value: true, Topic: /plan, Alpha: 1,
       Line Style: Billboards, Line Width: 0.04, Color: 20; 220; 30}
    - {Class: rviz/Marker, Name: Wall, Enabled: true, Value: true, Marker Topic: /wall,
       Namespaces: {}}
    - {Class: rviz/Effort, Name: Efforts, Enabled: true, Value: true, Topic: /joint_states, Alpha: 1,
       Robot Description: robot_description, Scale: 3, Width: 0.06, History Length: 1}
)";

constexpr char kPosesOfConfig[] =
    R"(    - {Class: rviz/InteractiveMarkers, Name: Handles, Enabled: true, Value: true,
       Update Topic: /handles/update, Show Descriptions: false, Show Axes: false,
       Enable Transparency: false}
    - {Class: rviz/PoseWithCovariance, Name: Guess, Enabled: true, Value: true, Topic: /guess,
       Shape: Arrow, Color: 255; 0; 140, Alpha: 1, Shaft Length: 1, Head Length: 0.3,
       Shaft Radius: 0.05, Head Radius: 0.1, Covariance: {Value: true,
       Position: {Value: true, Alpha: 1, Color: 60; 160; 255, Scale: 1},
       Orientation: {Value: true, Alpha: 1, Color: 230; 30; 220, Color Style: Unique, Frame: Local,
       Offset: 0.8, Scale: 1}}}
    - {Class: rviz/PoseArray, Name: Grips, Enabled: true, Value: true, Topic: /grips, Alpha: 1,
       Shape: Arrow (3D), Color: 0; 200; 255, Shaft Length: 0.69, Shaft Radius: 0.03,
       Head Length: 0.21, Head Radius: 0.09}
    - {Class: rviz/Path, Name: Plan, Enabled: true, Value: true, Topic: /plan, Alpha: 1,
       Line Style: Billboards, Line Width: 0.02, Color: 130; 60; 220, Pose Style: Arrows,
       Pose Color: 230; 204; 13, Shaft Length: 0.1, Head Length: 0.2, Shaft Diameter: 0.1,
       Head Diameter: 0.3}
)";

constexpr char kDepthsOfConfig[] =
    R"(    - {Class: rviz/DepthCloud, Name: Depths, Enabled: true, Value: true, Alpha: 1,
       Depth Map Topic: /eye/depth, Depth Map Transport Hint: raw, Color Image Topic: "",
       Color Transport Hint: raw, Queue Size: 5, Topic Filter: true, Position Transformer: XYZ,
       Color Transformer: FlatColor, Color: 230; 30; 220, Style: Flat Squares, Size (m): 0.03,
       Auto Size: {Auto Size Factor: 1, Value: false}, Use Fixed Frame: true,
       Occlusion Compensation: {Occlusion Time-Out: 30, Value: false}}
)";

constexpr char kCameraOfConfig[] =
    R"(    - {Class: rviz/Camera, Name: Eye, Enabled: true, Value: true, Image Topic: /eye/image,
       Image Rendering: background, Overlay Alpha: 0.5, Zoom Factor: 1, Queue Size: 2,
       Transport Hint: raw, Unreliable: false, Visibility: {Value: true}}
    - {Class: rviz/Marker, Name: Wall, Enabled: true, Value: true, Marker Topic: /wall,
       Namespaces: {}}
)";

// Without the frames whose names follow.
constexpr char kFramesOfConfig[] =
    R"(    - Class: rviz/TF
      Name: Frames
      Enabled: true
      Value: true
      Show Names: false
      Show Axes: true
      Show Arrows: true
      Marker Scale: 3
      Marker Alpha: 1
      Frame Timeout: 15
      Frames:
        All Enabled: false
)";

constexpr char kViewOfConfig[] = R"(  Enabled: true
  Global Options: {Background Color: 238; 240; 243, Fixed Frame: world, Frame Rate: 10}
  Tools: [{Class: rviz/Interact}]
  Value: true
  Views:
    Current:
      Class: rviz/ThirdPersonFollower
      Name: Current View
      Target Frame: cart
      Distance: 5.2
      Yaw: 0.3
      Pitch: 0.45
      Near Clip Distance: 0.01
      Focal Point: {X: 0, Y: 0, Z: 0}
      Focal Shape Fixed Size: false
      Focal Shape Size: 0.0001
    Saved: ~
Window Geometry: {Height: 600, Width: 800, X: 0, Y: 0, Hide Left Dock: true, Hide Right Dock: true}
)";
// The pane of a camera is there.
constexpr char kWindowWithPanes[] = "Hide Left Dock: false";

// A thing of the scene: nothing else there has its tint.
struct Thing {
  const char* name;
  std::array<int, 3> color;
};
const std::vector<Thing> kThings = {
    {"base", {26, 64, 230}},    {"hand", {230, 204, 13}},  {"cloud", {230, 30, 220}},
    {"heights", {0, 255, 255}}, {"effort", {255, 0, 100}}, {"push", {255, 140, 0}},
    {"path", {20, 220, 30}},    {"wall", {230, 30, 20}},   {"ring", {64, 0, 255}}};
const std::vector<Thing> kPartsOfFrames = {{"x axes", {255, 0, 0}},
                                           {"y axes", {0, 255, 0}},
                                           {"z axes", {0, 0, 255}},
                                           {"heads of arrows", {255, 26, 153}}};

// Of the rings and arrows of the marker: red, green and blue for the axes.
const std::vector<Thing> kPoses = {
    {"handles of x", {255, 0, 0}},         {"handles of y", {0, 255, 0}},
    {"handles of z", {0, 0, 255}},         {"position", {60, 160, 255}},
    {"orientation", {230, 30, 220}},       {"pose", {255, 0, 140}},
    {"poses of the array", {0, 200, 255}}, {"poses of the path", {230, 204, 13}}};

struct Place {
  std::array<double, 4> edges = {};  // px: left, right, top, bottom
  std::size_t pixels = 0;
};

// Light differs, tint does not: the share that each channel has in the sum. Kinescope's legend, on
// the left below, has something of each colour.
Place PlaceOf(const Thing& thing, const std::vector<std::array<int, 3>>& pixels, std::size_t width,
              bool has_legend = true) {
  constexpr std::size_t kLegendTop = 320;                   // px
  const std::size_t legend_right = has_legend ? 206u : 0u;  // px
  std::vector<double> x, y;
  const double whole = thing.color[0] + thing.color[1] + thing.color[2];
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const std::size_t column = i % width, row = i / width;
    const double sum = pixels[i][0] + pixels[i][1] + pixels[i][2];
    if (sum < 60 || (column < legend_right && row > kLegendTop)) continue;
    double off = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      off += std::abs(pixels[i][k] / sum - thing.color[k] / whole);
    }
    if (off > 0.15) continue;
    x.push_back(static_cast<double>(column));
    y.push_back(static_cast<double>(row));
  }
  if (x.empty()) return {};
  std::sort(x.begin(), x.end());
  std::sort(y.begin(), y.end());
  const std::size_t few = x.size() / 25;  // of something else
  return {{x[few], x[x.size() - 1 - few], y[few], y[y.size() - 1 - few]}, x.size()};
}

class RVizScene : public testing::RVizProgram {
 protected:
  void SetUp() override {
    RVizProgram::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    ros::param::set("/robot_description", std::string(kArmOfScene));
    joints_ = node_->advertise<sensor_msgs::JointState>("joint_states", 1, true);
    frames_ = node_->advertise<tf2_msgs::TFMessage>("/tf", 1);
    info_ = node_->advertise<sensor_msgs::CameraInfo>("/eye/camera_info", 1);
    image_ = node_->advertise<sensor_msgs::Image>("/eye/image", 1);
    depths_ = node_->advertise<sensor_msgs::Image>("/eye/depth", 1);
    PublishLatched<tf2_msgs::TFMessage>("/tf_static", WhereThingsStand());
    PublishLatched<sensor_msgs::PointCloud2>("/cloud", CloudFrom(0.3F));
    PublishLatched<sensor_msgs::PointCloud2>("/heights", CloudFrom(1.3F));
    PublishLatched<sensor_msgs::Temperature>("/effort", Effort());
    PublishLatched<geometry_msgs::WrenchStamped>("/push", Push());
    PublishLatched<nav_msgs::Path>("/plan", Plan());
    PublishLatched<visualization_msgs::Marker>("/wall", Wall());
    PublishLatched<geometry_msgs::PoseWithCovarianceStamped>("/guess", Guess());
    PublishLatched<geometry_msgs::PoseArray>("/grips", Grips());
  }

  // Of RViz itself: saves its configuration.
  bool SaveConfig(const std::string& file) {
    ros::ServiceClientOptions options("/rviz/save_config", "*", false, {});
    ros::ServiceClient client = node_->serviceClient(options);
    std_msgs::String path;
    std_msgs::Bool is_done;
    path.data = file;
    return client.exists() && client.call(path, is_done, "*") && is_done.data;
  }

  // Starts the server, and RViz anew, with the configuration in `file`.
  void StartBoth(const std::string& file, const std::string& window = "--fullscreen") {
    serve_ = Start(
        "serve demo:n_pose --ros required --http_port 0 --ros_view_size 800x600 "
        "--ros_view_rate_hz 5 --rviz '" +
        file + "'");
    WaitForParameter("/human_description");  // RViz reads it when it starts
    rviz_ = StartRViz(window);
    Hear<sensor_msgs::Image>("/kinescope/view/image_raw", [this](const sensor_msgs::Image& image) {
      ours_.resize(kWidth * kHeight);
      if (image.data.size() != 3 * ours_.size()) return;
      for (std::size_t i = 0; i < ours_.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) ours_[i][k] = image.data[3 * i + k];
      }
    });
  }

  // Neither says when it has drawn all: they have when they agree.
  void ExpectBothToShow(const std::vector<Thing>& things) {
    std::string told;
    const auto agree = [&] {
      MoveArm();
      PublishEye();
      if (ours_.empty()) return false;
      theirs_ = Grab();
      told.clear();
      bool is_same = true;
      for (const Thing& thing : things) {
        const Place a = PlaceOf(thing, theirs_, kWidth), b = PlaceOf(thing, ours_, kWidth);
        told += fmt::format("{}: RViz {} ({} px), Kinescope {} ({} px)\n", thing.name, a.edges,
                            a.pixels, b.edges, b.pixels);
        is_same = is_same && a.pixels > 300 && b.pixels > 300;
        for (std::size_t k = 0; k < 4; ++k) {
          is_same = is_same && std::abs(a.edges[k] - b.edges[k]) <= 3;
        }
      }
      return is_same;
    };
    EXPECT_TRUE(Spin(agree)) << told << testing::ReadFile(folder_ / "rviz.log");
    fmt::print("{}", told);
  }

  // What a camera at the side of the person has taken: an image of one colour, and depths of a
  // board 1.5 m before it.
  void PublishEye() {
    const ros::Time now = ros::Time::now();
    geometry_msgs::TransformStamped place = Standing("eye", 2.2, 1.2, 0.5, 0);
    place.header.stamp = now;
    place.transform.rotation.x = place.transform.rotation.y = -0.5;  // looks along -x
    place.transform.rotation.z = place.transform.rotation.w = 0.5;
    tf2_msgs::TFMessage places;
    places.transforms = {place};
    frames_.publish(places);
    sensor_msgs::CameraInfo info;
    info.header.stamp = now;
    info.header.frame_id = "eye";
    info.width = kEyeWidth;
    info.height = kEyeHeight;
    info.distortion_model = "plumb_bob";
    info.D.assign(5, 0);
    info.K = {kEyeFocal, 0, 70, 0, kEyeFocal, 65, 0, 0, 1};
    info.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    info.P = {kEyeFocal, 0, 70, 0, 0, kEyeFocal, 65, 0, 0, 0, 1, 0};
    info_.publish(info);
    sensor_msgs::Image image;
    image.header = info.header;
    image.width = kEyeWidth;
    image.height = kEyeHeight;
    image.encoding = "rgb8";
    image.step = 3 * kEyeWidth;
    for (std::uint32_t i = 0; i < kEyeWidth * kEyeHeight; ++i) {
      image.data.insert(image.data.end(), {255, 0, 255});
    }
    image_.publish(image);
    image.encoding = "16UC1";
    image.step = 2 * kEyeWidth;
    image.data.clear();
    for (std::uint32_t i = 0; i < kEyeWidth * kEyeHeight; ++i) {
      const std::uint32_t x = i % kEyeWidth, y = i / kEyeWidth;
      const bool is_board = x >= 40 && x < 100 && y >= 20 && y < 70;
      const int millimetres = is_board ? 1500 : 0;
      image.data.push_back(static_cast<std::uint8_t>(millimetres & 255));
      image.data.push_back(static_cast<std::uint8_t>(millimetres >> 8));
    }
    depths_.publish(image);
  }

  // Where `thing` is in the image of the camera, which is magenta: shares of its width and height.
  static Place PlaceInImage(const Thing& thing, const Pixels& pixels) {
    std::array<double, 4> image = {kWidth, 0, kHeight, 0};  // left, right, top, bottom
    const auto place_of = [](std::size_t i) {
      return std::pair(static_cast<double>(i % kWidth), static_cast<double>(i / kWidth));
    };
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const auto [red, green, blue] = pixels[i];
      if (red < 240 || green > 15 || blue < 240) continue;
      const auto [x, y] = place_of(i);
      image = {std::min(image[0], x), std::max(image[1], x), std::min(image[2], y),
               std::max(image[3], y)};
    }
    Pixels inside = pixels;
    for (std::size_t i = 0; i < inside.size(); ++i) {
      const auto [x, y] = place_of(i);
      if (x < image[0] || x > image[1] || y < image[2] || y > image[3]) inside[i] = {};
    }
    Place place = PlaceOf(thing, inside, kWidth, false);
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t first = k / 2 * 2;
      place.edges[k] = (place.edges[k] - image[first]) / (image[first + 1] - image[first]);
    }
    return place;
  }

  void SavePictures(const std::string& scene) const {
    for (const auto& [name, pixels] :
         {std::pair("rviz", &theirs_), std::pair("kinescope", &ours_)}) {
      std::string ppm = fmt::format("P6 {} {} 255\n", kWidth, kHeight);
      for (const std::array<int, 3>& color : *pixels) {
        for (const int channel : color) ppm += static_cast<char>(channel);
      }
      const std::filesystem::path folder = kinescope::testing::InBuild("screenshots");
      std::filesystem::create_directories(folder);
      std::ofstream(folder / fmt::format("{}_{}.ppm", scene, name), std::ios::binary) << ppm;
    }
  }

  Pixels ours_, theirs_;  // the newest pictures

  void MoveArm() {
    sensor_msgs::JointState message;
    message.header.stamp = ros::Time::now();
    message.name = {"lift"};
    message.position = {0.4};
    message.effort = {-0.1};  // of at most 1
    joints_.publish(message);
  }

 private:
  template <class Message>
  void PublishLatched(const std::string& topic, const Message& message) {
    latched_.push_back(node_->advertise<Message>(topic, 1, true));
    latched_.back().publish(message);
  }

  static geometry_msgs::TransformStamped Standing(const char* frame, double x, double y, double z,
                                                  double turn) {
    geometry_msgs::TransformStamped transform;
    transform.header.frame_id = "world";
    transform.child_frame_id = frame;
    transform.transform.translation.x = x;
    transform.transform.translation.y = y;
    transform.transform.translation.z = z;
    transform.transform.rotation.z = std::sin(turn / 2);
    transform.transform.rotation.w = std::cos(turn / 2);
    return transform;
  }

  static tf2_msgs::TFMessage WhereThingsStand() {
    tf2_msgs::TFMessage message;
    message.transforms = {
        Standing("base", 1.3, 0.6, 0, -1.2), Standing("sensor", 0.2, -1.3, 1.2, 0.5),
        Standing("tool", 0.4, 1.2, 0.9, 0.5), Standing("cart", 1.266, 0.111, -0.337, 0.4)};
    return message;
  }

  static sensor_msgs::Temperature Effort() {
    sensor_msgs::Temperature effort;
    effort.header.frame_id = "sensor";
    effort.temperature = 45;
    return effort;
  }

  static geometry_msgs::WrenchStamped Push() {
    geometry_msgs::WrenchStamped push;
    push.header.frame_id = "tool";
    push.wrench.force.z = 150;
    push.wrench.torque.x = 5;
    return push;
  }

  // A wall that begins at this height, m.
  static sensor_msgs::PointCloud2 CloudFrom(float height) {
    sensor_msgs::PointCloud2 cloud;
    cloud.header.frame_id = "world";
    cloud.height = 1;
    cloud.fields.resize(3);
    for (std::uint32_t i = 0; i < 3; ++i) {
      cloud.fields[i].name = std::string(1, "xyz"[i]);
      cloud.fields[i].offset = 4 * i;
      cloud.fields[i].datatype = sensor_msgs::PointField::FLOAT32;
      cloud.fields[i].count = 1;
    }
    cloud.point_step = 12;
    for (int i = 0; i < 20; ++i) {
      for (int k = 0; k < 20; ++k) {
        const std::array<float, 3> point = {1.1F + 0.03F * static_cast<float>(i), -0.9F,
                                            height + 0.03F * static_cast<float>(k)};
        const auto* const bytes = reinterpret_cast<const std::uint8_t*>(point.data());
        cloud.data.insert(cloud.data.end(), bytes, bytes + 12);
      }
    }
    cloud.width = 400;
    cloud.row_step = 12 * cloud.width;
    cloud.is_dense = 1U;
    return cloud;
  }

  static nav_msgs::Path Plan() {
    nav_msgs::Path path;
    path.header.frame_id = "world";
    for (int i = 0; i <= 30; ++i) {
      geometry_msgs::PoseStamped pose;
      pose.header.frame_id = "world";
      pose.pose.position.x = 0.9 + 0.05 * i;
      pose.pose.position.y = -0.3 + 0.2 * std::sin(0.2 * i);
      pose.pose.position.z = 0.05;
      pose.pose.orientation.w = 1;
      path.poses.push_back(pose);
    }
    return path;
  }

  static geometry_msgs::Pose At(double x, double y, double z, double yaw) {
    geometry_msgs::Pose pose;
    pose.position.x = x;
    pose.position.y = y;
    pose.position.z = z;
    pose.orientation.z = std::sin(yaw / 2);
    pose.orientation.w = std::cos(yaw / 2);
    return pose;
  }

  static geometry_msgs::PoseWithCovarianceStamped Guess() {
    geometry_msgs::PoseWithCovarianceStamped guess;
    guess.header.frame_id = "world";
    guess.pose.pose = At(0.4, 1.2, 0.5, -0.1);
    auto& covariance = guess.pose.covariance;
    covariance[0] = 0.01;  // m²: of x, y and z
    covariance[7] = 0.04;
    covariance[14] = 0.0025;
    covariance[21] = covariance[28] = 0.01;  // rad²: about x, y and z
    covariance[35] = 0.04;
    covariance[29] = covariance[34] = 0.008;
    return guess;
  }

  static geometry_msgs::PoseArray Grips() {
    geometry_msgs::PoseArray grips;
    grips.header.frame_id = "sensor";
    for (int i = 0; i < 4; ++i) grips.poses.push_back(At(0.1 * i, 0.25 * i, 0, 0.3 * i));
    return grips;
  }

  static visualization_msgs::Marker Wall() {
    visualization_msgs::Marker wall;
    wall.header.frame_id = "world";
    wall.ns = "walls";
    wall.type = visualization_msgs::Marker::CUBE;
    wall.pose.position.x = 0.4;
    wall.pose.position.y = 1.2;
    wall.pose.position.z = 0.3;
    wall.pose.orientation.w = 1;
    wall.scale.x = 0.4;
    wall.scale.y = 0.1;
    wall.scale.z = 0.6;
    wall.color.r = 0.9F;
    wall.color.g = 0.12F;
    wall.color.b = 0.08F;
    wall.color.a = 1;
    return wall;
  }

  static constexpr std::uint32_t kEyeWidth = 160, kEyeHeight = 120;  // px
  static constexpr double kEyeFocal = 90;                            // px
  ros::Publisher joints_, frames_, info_, image_, depths_;
  std::vector<ros::Publisher> latched_;
  std::unique_ptr<Process> serve_, rviz_;
};

TEST_F(RVizScene, IsShownByServeWithItsConfigurationAsRVizShowsIt) {
  Write("view.rviz", std::string(kPersonOfConfig) + kThingsOfConfig + kViewOfConfig);
  const Process publisher({KINESCOPE_ROBOT_STATE_PUBLISHER, "__name:=robot_state_publisher"});
  const std::string saved = (folder_ / "saved.rviz").string();
  {
    const auto rviz = StartRViz();
    ASSERT_TRUE(Spin([&] { return SaveConfig(saved); })) << testing::ReadFile(folder_ / "rviz.log");
  }
  std::filesystem::copy_file(saved, folder_ / "view.rviz",
                             std::filesystem::copy_options::overwrite_existing);
  StartBoth(saved);
  ExpectBothToShow(kThings);
  SavePictures("scene");
}

// One that moves along each axis and turns about it; RViz makes its arrows and rings.
visualization_msgs::InteractiveMarker MarkerOfSixDegrees() {
  using visualization_msgs::InteractiveMarkerControl;
  visualization_msgs::InteractiveMarker marker;
  marker.header.frame_id = "base";
  marker.name = "goal";
  marker.scale = 0.5F;
  for (int axis = 0; axis < 3; ++axis) {
    InteractiveMarkerControl control;
    control.orientation.w = std::sqrt(0.5);
    (axis == 0   ? control.orientation.x
     : axis == 1 ? control.orientation.z
                 : control.orientation.y) = std::sqrt(0.5);
    control.interaction_mode = InteractiveMarkerControl::MOVE_AXIS;
    marker.controls.push_back(control);
    control.interaction_mode = InteractiveMarkerControl::ROTATE_AXIS;
    marker.controls.push_back(control);
  }
  return marker;
}

// A server in this process, as other nodes have it.
TEST_F(RVizScene, HasInteractiveMarkersAndUncertainPosesAsRVizShowsThem) {
  Write("view.rviz", std::string(kPersonOfConfig) + kPosesOfConfig + kViewOfConfig);
  const Process publisher({KINESCOPE_ROBOT_STATE_PUBLISHER, "__name:=robot_state_publisher"});
  interactive_markers::InteractiveMarkerServer server("handles", "", true);
  server.insert(MarkerOfSixDegrees());
  server.applyChanges();
  StartBoth((folder_ / "view.rviz").string());
  geometry_msgs::Pose moved;
  moved.position.x = 0.2;
  moved.position.z = 1.1;
  moved.orientation.w = std::cos(0.3);
  moved.orientation.z = std::sin(0.3);
  server.setPose("goal", moved);
  server.applyChanges();
  ExpectBothToShow(kPoses);
  SavePictures("poses");
}

TEST_F(RVizScene, HasTheFramesOfTfAsRVizShowsThem) {
  const Process publisher({KINESCOPE_ROBOT_STATE_PUBLISHER, "__name:=robot_state_publisher"});
  // Those of the person are many: without them.
  const auto urdf = testing::RunProgram({testing::KinescopePath(), "urdf"});
  std::string config = std::string(kPersonOfConfig) + kFramesOfConfig;
  const std::regex link("<link name=\"([^\"]+)\"");
  for (std::sregex_iterator at(urdf.out.begin(), urdf.out.end(), link), end; at != end; ++at) {
    config += "        " + (*at)[1].str() + ": {Value: false}\n";
  }
  Write("view.rviz", config + kViewOfConfig);
  StartBoth((folder_ / "view.rviz").string());
  ExpectBothToShow(kPartsOfFrames);
  SavePictures("frames");
}

TEST_F(RVizScene, HasDepthsAsRVizShowsThem) {
  Write("view.rviz", std::string(kPersonOfConfig) + kDepthsOfConfig + kViewOfConfig);
  StartBoth((folder_ / "view.rviz").string());
  ExpectBothToShow({{"board", {230, 30, 220}}});
  SavePictures("depths");
}

TEST_F(RVizScene, IsOverTheImageOfACameraAsInRViz) {
  std::string view = kViewOfConfig;
  const std::string hidden = "Hide Left Dock: true";
  view.replace(view.find(hidden), hidden.size(), kWindowWithPanes);
  Write("view.rviz", std::string(kPersonOfConfig) + kCameraOfConfig + view);
  StartBoth((folder_ / "view.rviz").string(), "");
  const Thing wall = {"wall", {230, 30, 20}};
  std::string told;
  const auto agree = [&] {
    PublishEye();
    if (ours_.empty()) return false;
    theirs_ = Grab();
    const Place a = PlaceInImage(wall, theirs_), b = PlaceInImage(wall, ours_);
    told = fmt::format("RViz {} ({} px), Kinescope {} ({} px)\n", a.edges, a.pixels, b.edges,
                       b.pixels);
    bool is_same = a.pixels > 100 && b.pixels > 100;
    for (std::size_t k = 0; k < 4; ++k) {
      is_same = is_same && std::abs(a.edges[k] - b.edges[k]) <= 0.02;
    }
    return is_same;
  };
  EXPECT_TRUE(Spin(agree)) << told << testing::ReadFile(folder_ / "rviz.log");
  fmt::print("{}", told);
  SavePictures("camera");
}

}  // namespace
}  // namespace kinescope
