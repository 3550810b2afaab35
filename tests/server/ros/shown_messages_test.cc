#include "server/ros/shown_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <set>

#include "server/ros/marker_input.h"

namespace kinescope::ros_bridge {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using visualization_msgs::Marker;

template <class Message>
std::vector<std::uint8_t> BytesOfMessage(const Message& message) {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream out(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(out, message);
  return bytes;
}

// As the inbox does it: by the type that the connection states. Each of them can be drawn.
template <class Message>
ShownMarkers ShownOf(const Message& message, const ShownStyle& style = {}) {
  const auto convert = FindShownMessage(ros::message_traits::md5sum<Message>());
  if (convert == nullptr) return {};
  const auto markers = convert(BytesOfMessage(message), style);
  if (!markers) return {};
  MarkerStore store;
  for (const Marker& marker : *markers) {
    const auto refusal = store.Apply(0, marker, 0);
    EXPECT_FALSE(refusal) << refusal->text;
  }
  return *markers;
}

template <class Message>
Message InFrame() {
  Message message;
  message.header.frame_id = "cart";
  message.header.stamp = ros::Time(7, 8);
  return message;
}

std::array<int, 3> RgbOf(const std_msgs::ColorRGBA& color) {
  const auto level = [](float share) { return static_cast<int>(std::lround(255 * share)); };
  return {level(color.r), level(color.g), level(color.b)};
}

// Colours and sizes: the defaults of rviz/default_plugin/*_display.cpp 1.14.
TEST(ShownMessages, APointIsASphere) {
  auto point = InFrame<geometry_msgs::PointStamped>();
  point.point.z = 1.5;
  const ShownMarkers markers = ShownOf(point);
  ASSERT_THAT(markers, SizeIs(1));
  EXPECT_EQ(markers[0].type, Marker::SPHERE);
  EXPECT_EQ(markers[0].header.frame_id, "cart");
  EXPECT_EQ(markers[0].header.stamp, ros::Time(7, 8));
  EXPECT_DOUBLE_EQ(markers[0].pose.position.z, 1.5);
  EXPECT_DOUBLE_EQ(markers[0].scale.x, 0.4);
  EXPECT_EQ(RgbOf(markers[0].color), (std::array<int, 3>{204, 41, 204}));
}

TEST(ShownMessages, APoseIsAnArrowAlongX) {
  auto pose = InFrame<geometry_msgs::PoseStamped>();
  pose.pose.orientation.z = 1;  // x is -x
  pose.pose.position.y = 2;
  const ShownMarkers markers = ShownOf(pose);
  ASSERT_THAT(markers, SizeIs(1));
  EXPECT_EQ(markers[0].type, Marker::ARROW);
  EXPECT_DOUBLE_EQ(markers[0].pose.orientation.z, 1);
  EXPECT_DOUBLE_EQ(markers[0].points.at(1).x, 1.3);
  EXPECT_EQ(RgbOf(markers[0].color), (std::array<int, 3>{255, 25, 0}));
}

TEST(ShownMessages, PosesAreFlatArrows) {
  auto poses = InFrame<geometry_msgs::PoseArray>();
  poses.poses.resize(2);
  poses.poses[0].position.x = 1;  // without an orientation
  poses.poses[1].orientation.z = poses.poses[1].orientation.w = std::sqrt(0.5);
  const ShownMarkers markers = ShownOf(poses);
  ASSERT_THAT(markers, SizeIs(1));
  EXPECT_EQ(markers[0].type, Marker::LINE_LIST);
  ASSERT_THAT(markers[0].points, SizeIs(12));
  EXPECT_NEAR(markers[0].points[1].x, 1.3, 1e-12);
  EXPECT_NEAR(markers[0].points[3].x, 1.225, 1e-12);
  EXPECT_NEAR(markers[0].points[3].y, 0.06, 1e-12);
  EXPECT_NEAR(markers[0].points[7].y, 0.3, 1e-12) << "the second one points along y";
  poses.poses.clear();
  EXPECT_EQ(ShownOf(poses).at(0).action, Marker::DELETE) << "what was shown before is gone";
  poses.poses.resize(20'000);
  const auto refused = ToMarkers(poses);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().text, "20000 poses: expected at most 16666");
}

TEST(ShownMessages, APathIsALineThroughItsPositions) {
  auto path = InFrame<nav_msgs::Path>();
  path.poses.resize(3);
  path.poses[1].pose.position.x = 1;
  path.poses[1].header.frame_id = "elsewhere";  // RViz uses the frame of the path
  const ShownMarkers markers = ShownOf(path);
  ASSERT_THAT(markers, SizeIs(1));
  EXPECT_EQ(markers[0].type, Marker::LINE_STRIP);
  EXPECT_EQ(markers[0].header.frame_id, "cart");
  EXPECT_THAT(markers[0].points, SizeIs(3));
  ShownStyle axes;
  axes.has_axes = true;
  const ShownMarkers with_axes = ShownOf(path, axes);
  ASSERT_THAT(with_axes, SizeIs(2));
  EXPECT_THAT(with_axes[0].points, SizeIs(3));
  ASSERT_THAT(with_axes[1].points, SizeIs(3 * 6));
  EXPECT_NEAR(with_axes[1].points[7].x, 1.3, 1e-12);
  EXPECT_DOUBLE_EQ(with_axes[0].scale.x, 0.02);
  EXPECT_DOUBLE_EQ(with_axes[1].scale.x, 0.03) << "they are as wide as they are, not as the line";
  path.poses.resize(1);
  EXPECT_EQ(ShownOf(path).at(0).action, Marker::DELETE);
}

TEST(ShownMessages, AWrenchIsAnArrowForItsForceAndOneForItsMoment) {
  auto wrench = InFrame<geometry_msgs::WrenchStamped>();
  wrench.wrench.force.z = 700;
  wrench.wrench.torque.x = -20;
  ShownMarkers markers = ShownOf(wrench);
  ASSERT_THAT(markers, SizeIs(2));
  EXPECT_NEAR(markers[0].points.at(1).z, 0.7, 1e-12);
  EXPECT_NEAR(markers[1].points.at(1).x, -0.2, 1e-12);
  wrench.wrench.force.z = 4;
  markers = ShownOf(wrench);
  EXPECT_EQ(markers.at(0).action, Marker::DELETE);
  EXPECT_EQ(markers.at(1).action, Marker::ADD);
}

TEST(ShownMessages, AWrenchHasTheArrowsOfRvizIfItsScalesAreGiven) {
  auto wrench = InFrame<geometry_msgs::WrenchStamped>();
  wrench.wrench.force.z = 700;
  wrench.wrench.torque.x = -20;
  ShownStyle style;
  style.color = Rgb{1, 1, 0};
  style.wrench.force_m = 1.3 * 0.002;
  style.wrench.torque_m = 0;
  style.width_m = 0.3;
  style.wrench.torque_color = Rgb{0, 0, 1};
  ShownMarkers markers = ShownOf(wrench, style);
  EXPECT_NEAR(markers.at(0).points.at(1).z, 1.3 * 1.4, 1e-12) << "shaft and head";
  EXPECT_NEAR(markers[0].scale.z, 0.3 * 1.4, 1e-12);
  EXPECT_NEAR(markers[0].scale.x, 0.03, 1e-12);
  EXPECT_EQ(markers.at(1).action, Marker::DELETE);
  style.wrench.torque_m = 1.3 * 0.01;  // a shaft of 0.2 m, which is less than the width
  EXPECT_EQ(ShownOf(wrench, style).at(1).action, Marker::DELETE);
  style.wrench.hides_small = false;
  markers = ShownOf(wrench, style);
  EXPECT_NEAR(markers.at(1).points.at(1).x, -0.26, 1e-12);
  EXPECT_EQ(RgbOf(markers[1].color), (std::array<int, 3>{0, 0, 255}));
  EXPECT_EQ(RgbOf(markers[0].color), (std::array<int, 3>{255, 255, 0}));
  // A ring about the middle of its shaft, which is 0.2 m long and points along -x.
  ASSERT_THAT(markers, SizeIs(4));
  ASSERT_THAT(markers[2].points, SizeIs(29));
  for (const auto& point : markers[2].points) {
    EXPECT_NEAR(point.x, -0.1, 1e-12);
    EXPECT_NEAR(std::hypot(point.y, point.z), 0.05, 1e-12);
  }
  EXPECT_NEAR(markers[2].scale.x, 0.05 * 0.3, 1e-12);
  EXPECT_NEAR(markers[3].points.at(0).y, markers[2].points.back().y, 1e-12) << "it ends in a head";
  EXPECT_NEAR(markers[3].points.at(0).z, markers[2].points.back().z, 1e-12);
  const auto ring = [&](std::size_t i) {
    const auto& at = markers[2].points.at(i);
    return Eigen::Vector3d(at.x, at.y, at.z);
  };
  const Eigen::Vector3d center(-0.1, 0, 0);
  EXPECT_LT((ring(0) - center).cross(ring(1) - center).x(), 0) << "the way that it turns";
  wrench.wrench.torque.x = 0;
  EXPECT_EQ(ShownOf(wrench, style).at(1).action, Marker::DELETE) << "it has no direction";
  EXPECT_EQ(ShownOf(wrench, style).at(2).action, Marker::DELETE);
}

TEST(ShownMessages, ATwistAndAnAccelerationAreArrowsToo) {
  auto twist = InFrame<geometry_msgs::TwistStamped>();
  twist.twist.linear.x = 0.5;
  twist.twist.angular.z = 0.005;
  ShownMarkers markers = ShownOf(twist);
  EXPECT_NEAR(markers.at(0).points.at(1).x, 0.5, 1e-12);
  EXPECT_EQ(markers.at(1).action, Marker::DELETE);
  auto accel = InFrame<geometry_msgs::AccelStamped>();
  accel.accel.linear.z = 9.81;
  accel.accel.angular.y = 2;
  ShownStyle style;
  style.wrench.torque_m = 0.5;
  markers = ShownOf(accel, style);
  EXPECT_NEAR(markers.at(0).points.at(1).z, 0.981, 1e-12);
  EXPECT_NEAR(markers.at(1).points.at(1).y, 1, 1e-12);
}

TEST(ShownMessages, ARangeIsAConeAlongX) {
  auto range = InFrame<sensor_msgs::Range>();
  range.min_range = 0.1F;
  range.max_range = 4;
  range.range = 2;
  range.field_of_view = 0.5F;
  const Marker cone = ShownOf(range).at(0);
  ASSERT_EQ(cone.type, Marker::TRIANGLE_LIST);
  EXPECT_NEAR(1 - std::pow(1 - cone.color.a, 2), 0.5, 1e-6) << "front and back together";
  double farthest = 0, widest = 0;
  for (const auto& point : cone.points) {
    farthest = std::max(farthest, point.x);
    widest = std::max(widest, point.z);
  }
  EXPECT_NEAR(farthest, 2, 1e-6);
  EXPECT_NEAR(widest, 2 * std::tan(0.25), 1e-6);
  range.range = 5;
  EXPECT_EQ(ShownOf(range).at(0).action, Marker::DELETE) << "nothing is seen";
  range.range = -std::numeric_limits<float>::infinity();
  EXPECT_EQ(ShownOf(range).at(0).action, Marker::DELETE);
  range.max_range = range.min_range;  // a sensor that says only that something is there
  EXPECT_EQ(ShownOf(range).at(0).action, Marker::ADD);
  range.field_of_view = 3.2F;
  EXPECT_THAT(ShownOf(range), SizeIs(0));
}

TEST(ShownMessages, APoseHasTheEllipsoidOfItsCovarianceIfTold) {
  auto odometry = InFrame<nav_msgs::Odometry>();
  odometry.pose.pose.position.x = 3;
  odometry.pose.pose.orientation.w = 1;
  auto& covariance = odometry.pose.covariance;
  covariance[0] = covariance[7] = 0.05;  // of x and y, which go together
  covariance[1] = covariance[6] = 0.04;
  covariance[14] = 0.0025;
  EXPECT_THAT(ShownOf(odometry), SizeIs(1));
  ShownStyle style;
  style.covariance.scale = 2;
  const ShownMarkers markers = ShownOf(odometry, style);
  ASSERT_THAT(markers, SizeIs(2));
  const Marker& ellipsoid = markers[1];
  EXPECT_EQ(ellipsoid.type, Marker::SPHERE);
  EXPECT_EQ(ellipsoid.pose.position.x, 3);
  EXPECT_NEAR(ellipsoid.color.a, 0.3, 1e-6);
  EXPECT_NEAR(ellipsoid.scale.z, 2 * 2 * 0.3, 1e-9) << "the largest last";
  EXPECT_NEAR(ellipsoid.scale.y, 2 * 2 * 0.1, 1e-9);
  EXPECT_NEAR(ellipsoid.scale.x, 2 * 2 * 0.05, 1e-9);
  const Eigen::Quaterniond turn(ellipsoid.pose.orientation.w, ellipsoid.pose.orientation.x,
                                ellipsoid.pose.orientation.y, ellipsoid.pose.orientation.z);
  EXPECT_NEAR(std::abs((turn * Eigen::Vector3d::UnitZ()).dot(Eigen::Vector3d(1, 1, 0))),
              std::sqrt(2), 1e-9);
  covariance[14] = 0;
  EXPECT_EQ(ShownOf(odometry, style).at(1).action, Marker::ADD) << "a flat one";
  covariance.fill(0);
  EXPECT_EQ(ShownOf(odometry, style).at(1).action, Marker::DELETE);
  covariance[0] = std::nan("");
  EXPECT_EQ(ShownOf(odometry, style).at(1).action, Marker::DELETE);
}

// A marker turns its z to here.
Eigen::Vector3d NormalOf(const Marker& marker) {
  const geometry_msgs::Quaternion& q = marker.pose.orientation;
  return Eigen::Quaterniond(q.w, q.x, q.y, q.z) * Eigen::Vector3d::UnitZ();
}

Eigen::Vector3d PlaceOf(const Marker& marker) {
  return {marker.pose.position.x, marker.pose.position.y, marker.pose.position.z};
}

TEST(ShownMessages, APoseHasDiscsWhereItsAxesMayPointIfTold) {
  auto guess = InFrame<geometry_msgs::PoseWithCovarianceStamped>();
  guess.pose.pose.position.x = 3;
  guess.pose.pose.orientation.w = guess.pose.pose.orientation.z = std::sqrt(0.5);  // x is y
  auto& covariance = guess.pose.covariance;
  covariance[21] = 0.04;  // rad²: about x
  covariance[28] = 0.01;
  covariance[35] = 0.0025;
  ShownStyle style;
  style.turn_covariance.scale = 2;
  style.turn_covariance.offset_m = 0.5;
  const ShownMarkers markers = ShownOf(guess, style);
  ASSERT_THAT(markers, SizeIs(4));
  EXPECT_EQ(RgbOf(markers[1].color), (std::array<int, 3>{255, 255, 127}));
  EXPECT_FLOAT_EQ(markers[1].color.a, 0.5F);
  // The tip of x goes sideways by what turns about y and z, and so on.
  const std::array<std::array<double, 2>, 3> deviations = {{{0.1, 0.05}, {0.2, 0.05}, {0.2, 0.1}}};
  const std::array<Eigen::Vector3d, 3> axes = {
      {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}};  // of the pose, in its frame
  for (std::size_t i = 0; i < 3; ++i) {
    const Marker& disc = markers[1 + i];
    EXPECT_EQ(disc.type, Marker::CYLINDER);
    EXPECT_TRUE(PlaceOf(disc).isApprox(Eigen::Vector3d(3, 0, 0) + 0.5 * axes.at(i), 1e-9)) << i;
    EXPECT_NEAR(std::abs(NormalOf(disc).dot(axes.at(i))), 1, 1e-9) << i;
    EXPECT_NEAR(disc.scale.x, 2 * 0.5 * std::tan(2 * deviations.at(i)[0]), 1e-9) << i;
    EXPECT_NEAR(disc.scale.y, 2 * 0.5 * std::tan(2 * deviations.at(i)[1]), 1e-9) << i;
  }
  style.turn_covariance.has_axis_colors = true;
  EXPECT_EQ(RgbOf(ShownOf(guess, style).at(2).color), (std::array<int, 3>{0, 255, 0}));
  covariance.fill(0);
  covariance[14] = 1;
  EXPECT_EQ(ShownOf(guess, style).at(3).action, Marker::DELETE) << "sure";
  covariance[21] = 1e6;
  EXPECT_LT(ShownOf(guess, style).at(2).scale.x, 100) << "no more than 89 degrees";
  covariance[21] = std::nan("");
  EXPECT_EQ(ShownOf(guess, style).at(2).action, Marker::DELETE);
}

TEST(ShownMessages, APoseInThePlaneHasAWedge) {
  auto odometry = InFrame<nav_msgs::Odometry>();
  odometry.pose.pose.orientation.w = 1;
  odometry.pose.covariance[35] = 0.01;
  ShownStyle style;
  style.turn_covariance.scale = 1;
  const ShownMarkers markers = ShownOf(odometry, style);
  ASSERT_THAT(markers, SizeIs(4));
  ASSERT_THAT(markers[1].points, SizeIs(3));
  EXPECT_DOUBLE_EQ(markers[1].points[1].x, 1);
  EXPECT_DOUBLE_EQ(markers[1].points[2].y, std::tan(0.1));
  EXPECT_EQ(markers[2].action, Marker::DELETE) << "if it was not in the plane before";
}

TEST(ShownMessages, PosesInAnArrayAndAlongAPathAreSolidArrowsIfTold) {
  const auto box_of = [](const Marker& marker) {
    Eigen::AlignedBox3d box;
    for (const auto& point : marker.points) box.extend(Eigen::Vector3d(point.x, point.y, point.z));
    return box;
  };
  ShownStyle style;
  style.has_arrows = true;
  auto array = InFrame<geometry_msgs::PoseArray>();
  array.poses.resize(1);
  array.poses[0].position.x = 2;
  const ShownMarkers arrows = ShownOf(array, style);
  EXPECT_EQ(arrows.at(0).type, Marker::TRIANGLE_LIST);
  EXPECT_NEAR(box_of(arrows[0]).max().x(), 2.3, 1e-9);
  EXPECT_NEAR(box_of(arrows[0]).sizes().y(), 0.03, 1e-9) << "of its head";
  array.poses.resize(5000);
  EXPECT_EQ(ShownOf(array, style).at(0).type, Marker::LINE_LIST) << "flat, if they are many";
  auto path = InFrame<nav_msgs::Path>();
  path.poses.resize(2);
  path.poses[1].pose.position.x = 1;
  style.poses.size_m = 0.6;
  style.poses.color = Rgb{0, 0, 1};
  const ShownMarkers markers = ShownOf(path, style);
  ASSERT_THAT(markers, SizeIs(2));
  EXPECT_EQ(markers[0].type, Marker::LINE_STRIP);
  EXPECT_EQ(RgbOf(markers[0].color), (std::array<int, 3>{25, 255, 0}));
  EXPECT_EQ(RgbOf(markers[1].color), (std::array<int, 3>{0, 0, 255}));
  EXPECT_NEAR(box_of(markers[1]).max().x(), 1.6, 1e-9);
  path.poses.clear();
  EXPECT_EQ(ShownOf(path, style).at(1).action, Marker::DELETE);
  path.poses.resize(1000);
  EXPECT_EQ(ToMarkers(path, style).error().text, "1000 poses: expected at most 555");
}

// As human-dynamics-estimation shows the efforts of joints: a sphere at each, green to red.
TEST(ShownMessages, AMeasuredValueIsASphereInItsColour) {
  auto effort = InFrame<sensor_msgs::Temperature>();
  effort.temperature = 45;
  ShownStyle style;
  style.has_spheres = true;
  style.size_m = 0.15;
  style.scale = PointScale{"temperature", false, 0, 90, Rgb{0, 1, 0}, Rgb{1, 0, 0}};
  ShownMarkers markers = ShownOf(effort, style);
  ASSERT_THAT(markers, SizeIs(1));
  EXPECT_EQ(markers[0].type, Marker::SPHERE);
  EXPECT_EQ(markers[0].header.frame_id, "cart");
  EXPECT_NEAR(markers[0].scale.x, 0.15, 1e-12);
  EXPECT_EQ(RgbOf(markers[0].color), (std::array<int, 3>{128, 128, 0}));
  style.scale->by = "intensity";
  EXPECT_EQ(RgbOf(ShownOf(effort, style).at(0).color), (std::array<int, 3>{255, 255, 255}))
      << "it has no such number";
  style.has_spheres = false;
  EXPECT_EQ(ShownOf(effort, style).at(0).type, Marker::POINTS) << "a square of this size";

  // RViz's own scales.
  effort.temperature = 100;
  EXPECT_EQ(RgbOf(ShownOf(effort).at(0).color), (std::array<int, 3>{255, 0, 0}));
  effort.temperature = std::nan("");
  EXPECT_THAT(ShownOf(effort), SizeIs(1));
  auto light = InFrame<sensor_msgs::Illuminance>();
  light.illuminance = 1000;
  EXPECT_EQ(RgbOf(ShownOf(light).at(0).color), (std::array<int, 3>{255, 0, 255}));
  auto pressure = InFrame<sensor_msgs::FluidPressure>();
  pressure.fluid_pressure = 98'000;
  EXPECT_EQ(RgbOf(ShownOf(pressure).at(0).color), (std::array<int, 3>{255, 0, 0}));
  auto damp = InFrame<sensor_msgs::RelativeHumidity>();
  damp.relative_humidity = 0.4;
  EXPECT_EQ(RgbOf(ShownOf(damp).at(0).color), (std::array<int, 3>{0, 255, 0}));
}

TEST(ShownMessages, AScanHasThePointsWithinItsRange) {
  auto scan = InFrame<sensor_msgs::LaserScan>();
  scan.angle_min = -1;
  scan.angle_increment = 1;
  scan.range_min = 0.1F;
  scan.range_max = 5;
  scan.ranges = {2, 1, 0.01F, 6, std::nanf("")};
  scan.intensities = {10, 30, 0, 0, 0};
  const ShownMarkers markers = ShownOf(scan);
  ASSERT_THAT(markers, SizeIs(1));
  EXPECT_EQ(markers[0].type, Marker::POINTS);
  ASSERT_THAT(markers[0].points, SizeIs(2));
  EXPECT_NEAR(markers[0].points[0].x, 2 * std::cos(1), 1e-6);
  EXPECT_NEAR(markers[0].points[0].y, -2 * std::sin(1), 1e-6);
  EXPECT_NEAR(markers[0].points[1].x, 1, 1e-6);
  EXPECT_EQ(RgbOf(markers[0].colors.at(0)), (std::array<int, 3>{255, 0, 0})) << "the least: red";
  EXPECT_EQ(RgbOf(markers[0].colors.at(1)), (std::array<int, 3>{255, 0, 255}));
}

TEST(ShownMessages, AScanSaysWhenItsPointsWereMeasured) {
  auto scan = InFrame<sensor_msgs::LaserScan>();
  scan.angle_increment = 0.1F;
  scan.range_max = 5;
  scan.ranges = {1, 6, 1, 1, 1};
  scan.time_increment = 0.02F;
  const auto sweep = ShownOf(scan).at(0).sweep;
  ASSERT_TRUE(sweep);
  EXPECT_NEAR(sweep->secs, 0.08, 1e-6) << "of all rays, as RViz has it";
  EXPECT_THAT(sweep->shares, ElementsAre(0, 0.5F, 0.75F, 1));
  for (const float none : {0.0F, std::nanf(""), 1e9F}) {
    scan.time_increment = none;
    EXPECT_FALSE(ShownOf(scan).at(0).sweep) << none;
  }
  scan.time_increment = 0.02F;
  scan.ranges = {1};
  EXPECT_FALSE(ShownOf(scan).at(0).sweep);
}

// x, y and z, and four bytes more under a name of its own.
sensor_msgs::PointCloud2 CloudOf(std::uint32_t points, const std::string& fourth,
                                 std::uint8_t type) {
  auto cloud = InFrame<sensor_msgs::PointCloud2>();
  cloud.height = 1;
  cloud.width = points;
  cloud.point_step = 16;
  cloud.row_step = 16 * points;
  cloud.data.resize(16 * std::size_t{points});
  for (const std::string& name : {std::string("x"), std::string("y"), std::string("z"), fourth}) {
    sensor_msgs::PointField field;
    field.name = name;
    field.offset = static_cast<std::uint32_t>(4 * cloud.fields.size());
    field.datatype = name == fourth ? type : std::uint8_t{sensor_msgs::PointField::FLOAT32};
    field.count = 1;
    cloud.fields.push_back(field);
  }
  return cloud;
}

template <class T>
void Put(sensor_msgs::PointCloud2& cloud, std::size_t point, std::size_t field, T value) {
  static_assert(sizeof value == 4);
  std::memcpy(&cloud.data.at(16 * point + 4 * field), &value, sizeof value);
}

TEST(ShownMessages, ACloudHasItsColoursOrThoseOfItsIntensities) {
  auto colored = CloudOf(3, "rgb", sensor_msgs::PointField::FLOAT32);
  Put(colored, 1, 0, 2.5F);
  Put(colored, 1, 3, std::uint32_t{0x00102030});
  Put(colored, 2, 1, std::nanf(""));  // no place
  ShownMarkers markers = ShownOf(colored);
  ASSERT_THAT(markers, SizeIs(1));
  ASSERT_THAT(markers[0].points, SizeIs(2));
  EXPECT_DOUBLE_EQ(markers[0].points[1].x, 2.5);
  EXPECT_EQ(RgbOf(markers[0].colors.at(1)), (std::array<int, 3>{0x10, 0x20, 0x30}));

  auto measured = CloudOf(3, "intensity", sensor_msgs::PointField::UINT32);
  for (std::uint32_t i = 0; i < 3; ++i) Put(measured, i, 3, 100 * i);
  markers = ShownOf(measured);
  EXPECT_EQ(RgbOf(markers[0].colors.at(0)), (std::array<int, 3>{255, 0, 0}));
  EXPECT_EQ(RgbOf(markers[0].colors.at(1)), (std::array<int, 3>{0, 255, 128}));
  EXPECT_EQ(RgbOf(markers[0].colors.at(2)), (std::array<int, 3>{255, 0, 255}));

  markers = ShownOf(CloudOf(3, "ring", sensor_msgs::PointField::UINT32));
  EXPECT_THAT(markers[0].colors, SizeIs(0));
  EXPECT_EQ(RgbOf(markers[0].color), (std::array<int, 3>{255, 255, 255}));
}

std::vector<std::array<int, 3>> ColorsOfCloud(const sensor_msgs::PointCloud2& cloud,
                                              const PointScale& scale) {
  ShownStyle style;
  style.scale = scale;
  const ShownMarkers markers = ShownOf(cloud, style);
  std::vector<std::array<int, 3>> colors;
  for (const auto& color : markers.at(0).colors) colors.push_back(RgbOf(color));
  return colors;
}

// Worked by hand from RViz's formulas: share = (value - least) / (most - least), the least red.
TEST(ShownMessages, ACloudHasTheColoursOfAScale) {
  using Colors = std::vector<std::array<int, 3>>;
  auto cloud = CloudOf(3, "ring", sensor_msgs::PointField::UINT32);
  for (std::uint32_t i = 0; i < 3; ++i) Put(cloud, i, 3, 10 * i);
  PointScale scale;
  scale.by = "ring";
  EXPECT_EQ(ColorsOfCloud(cloud, scale), (Colors{{255, 0, 0}, {0, 255, 128}, {255, 0, 255}}));
  scale.is_inverted = true;
  EXPECT_EQ(ColorsOfCloud(cloud, scale), (Colors{{255, 0, 255}, {0, 255, 128}, {255, 0, 0}}));
  scale.low = Rgb{0, 0, 0};
  EXPECT_EQ(ColorsOfCloud(cloud, scale), (Colors{{0, 0, 0}, {128, 128, 128}, {255, 255, 255}}));
  scale.high = Rgb{1, 0, 0};
  scale.from = 10;
  scale.to = 50;
  EXPECT_EQ(ColorsOfCloud(cloud, scale), (Colors{{0, 0, 0}, {0, 0, 0}, {64, 0, 0}}));
  scale.by = "intensity";
  EXPECT_EQ(ColorsOfCloud(cloud, scale), Colors{}) << "white, as in RViz: it has no such field";

  PointScale same;
  same.by = "ring";
  for (std::uint32_t i = 0; i < 3; ++i) Put(cloud, i, 3, std::uint32_t{7});
  EXPECT_EQ(ColorsOfCloud(cloud, same), (Colors{{255, 0, 0}, {255, 0, 0}, {255, 0, 0}}));
}

TEST(ShownMessages, AScaleComesBeforeColoursOfTheCloudAndAColourBeforeBoth) {
  auto cloud = CloudOf(2, "rgb", sensor_msgs::PointField::UINT32);
  Put(cloud, 1, 3, std::uint32_t{0x00102030});
  PointScale scale;
  scale.by = "rgb";
  EXPECT_EQ(ColorsOfCloud(cloud, scale).at(1), (std::array<int, 3>{255, 0, 255}));
  scale.by = "z";
  EXPECT_TRUE(ColorsOfCloud(cloud, scale).empty()) << "known when they have a place";
  ShownStyle style;
  style.scale = scale;
  style.color = Rgb{0, 1, 0};
  const ShownMarkers markers = ShownOf(cloud, style);
  EXPECT_TRUE(markers.at(0).colors.empty());
  EXPECT_EQ(RgbOf(markers.at(0).color), (std::array<int, 3>{0, 255, 0}));
}

TEST(ShownMessages, OfALargeCloudAsManyPointsAreShownThroughout) {
  const sensor_msgs::PointCloud2 cloud = CloudOf(50'000, "intensity", 7);
  EXPECT_THAT(ShownOf(cloud).at(0).points, SizeIs(20'000));
  ShownStyle style;
  style.most_points = 49'999;
  EXPECT_THAT(ShownOf(cloud, style).at(0).points, SizeIs(49'999));
  style.most_points = 50'000;
  EXPECT_THAT(ShownOf(cloud, style).at(0).points, SizeIs(50'000));
}

// Every 16th of 640 x 480 points would be 40 columns.
TEST(ShownMessages, ALargeCloudInRowsKeepsItsColumnsAndItsRows) {
  constexpr std::uint32_t kWidth = 640, kHeight = 480;
  auto cloud = CloudOf(kWidth * kHeight, "intensity", 7);
  cloud.width = kWidth;
  cloud.height = kHeight;
  cloud.row_step = 16 * kWidth;
  for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
    Put(cloud, i, 0, static_cast<float>(i % kWidth));
    Put(cloud, i, 1, static_cast<float>(i / kWidth));
  }
  std::set<double> columns, rows;
  const ShownMarkers markers = ShownOf(cloud);
  for (const auto& point : markers.at(0).points) {
    columns.insert(point.x);
    rows.insert(point.y);
  }
  EXPECT_EQ(columns.size(), kWidth);
  EXPECT_EQ(rows.size(), kHeight);
}

TEST(ShownMessages, ACloudHasTheColoursOfThreeNumbers) {
  auto cloud = CloudOf(1, "b", sensor_msgs::PointField::FLOAT32);
  for (const char* const name : {"r", "g"}) {
    cloud.fields.push_back(cloud.fields.back());
    cloud.fields.back().name = name;
  }
  cloud.fields[4].offset = 0;  // r: x
  cloud.fields[5].offset = 4;  // g: y
  Put(cloud, 0, 0, 1.0F);
  Put(cloud, 0, 1, 0.5F);
  Put(cloud, 0, 3, 7.0F);
  EXPECT_EQ(RgbOf(ShownOf(cloud).at(0).colors.at(0)), (std::array<int, 3>{255, 128, 255}));
}

TEST(ShownMessages, ACloudHasTheColoursOfAnAxisOfItsOwnFrame) {
  auto cloud = CloudOf(2, "ring", sensor_msgs::PointField::UINT32);
  Put(cloud, 1, 2, 3.0F);
  PointScale scale;
  scale.by = "z";
  scale.is_in_message = true;
  EXPECT_EQ(ColorsOfCloud(cloud, scale),
            (std::vector<std::array<int, 3>>{{255, 0, 0}, {255, 0, 255}}));
}

TEST(ShownMessages, ManyPointsAreSquaresRatherThanSpheresOrCubes) {
  ShownStyle style;
  style.has_spheres = true;
  EXPECT_EQ(ShownOf(CloudOf(500, "ring", 7), style).at(0).type, Marker::SPHERE_LIST);
  EXPECT_EQ(ShownOf(CloudOf(501, "ring", 7), style).at(0).type, Marker::POINTS);
  style.has_spheres = false;
  style.has_cubes = true;
  EXPECT_EQ(ShownOf(CloudOf(5'000, "ring", 7), style).at(0).type, Marker::CUBE_LIST);
  EXPECT_EQ(ShownOf(CloudOf(5'001, "ring", 7), style).at(0).type, Marker::POINTS);
}

TEST(ShownMessages, ACloudThatContradictsItselfIsRefused) {
  const auto why = [](const sensor_msgs::PointCloud2& cloud) {
    const auto markers = ToMarkers(cloud);
    return markers ? std::string() : markers.error().text;
  };
  const sensor_msgs::PointCloud2 good = CloudOf(4, "intensity", 7);
  EXPECT_EQ(why(good), "");
  auto bad = good;
  bad.width = 0xFFFFFFFF;
  EXPECT_THAT(why(bad), HasSubstr("more points than it has"));
  bad = good;
  bad.height = 0xFFFFFFFF;
  EXPECT_THAT(why(bad), HasSubstr("more points than it has"));
  bad = good;
  bad.data.pop_back();
  EXPECT_THAT(why(bad), HasSubstr("more points than it has"));
  bad = good;
  bad.fields[2].offset = 13;
  EXPECT_THAT(why(bad), HasSubstr("its field z ends at byte 17 of points of 16 bytes"));
  bad = good;
  bad.fields[1].datatype = 200;
  EXPECT_THAT(why(bad), HasSubstr("its field y is of no type: 200"));
  bad = good;
  bad.fields[1].datatype = sensor_msgs::PointField::FLOAT64;
  bad.fields[1].offset = 0;
  EXPECT_THAT(why(bad), HasSubstr("its field y is not of type FLOAT32"));
  bad = good;
  bad.is_bigendian = 1;
  EXPECT_THAT(why(bad), HasSubstr("big-endian"));
  bad = good;
  bad.fields[3].offset = 0xFFFFFFFF;
  EXPECT_EQ(why(bad), "") << "its intensity is not read";
  bad.width = bad.height = bad.row_step = bad.point_step = 0;
  EXPECT_THAT(why(bad), HasSubstr("its field x ends at byte 4 of points of 0 bytes"));
}

TEST(ShownMessages, APoseMayHaveAxes) {
  auto odometry = InFrame<nav_msgs::Odometry>();
  odometry.pose.pose.position.z = 1;
  odometry.pose.pose.orientation.z = odometry.pose.pose.orientation.w = std::sqrt(0.5);
  EXPECT_EQ(ShownOf(odometry).at(0).type, Marker::ARROW);
  ShownStyle axes;
  axes.has_axes = true;
  axes.size_m = 0.5;
  axes.alpha = 0.25;
  const ShownMarkers markers = ShownOf(odometry, axes);
  ASSERT_THAT(markers, SizeIs(1));
  EXPECT_EQ(markers[0].type, Marker::LINE_LIST);
  ASSERT_THAT(markers[0].points, SizeIs(6));
  EXPECT_EQ(markers[0].pose.position.z, 1);
  EXPECT_NEAR(markers[0].pose.orientation.z, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(markers[0].points[1].x, 0.5, 1e-12);
  EXPECT_NEAR(markers[0].points[3].y, 0.5, 1e-12);
  EXPECT_NEAR(markers[0].points[5].z, 0.5, 1e-12);
  EXPECT_EQ(RgbOf(markers[0].colors.at(1)), (std::array<int, 3>{255, 0, 0}));
  EXPECT_EQ(RgbOf(markers[0].colors.at(4)), (std::array<int, 3>{0, 0, 255}));
  EXPECT_EQ(markers[0].colors.at(4).a, 0.25F);
  EXPECT_DOUBLE_EQ(markers[0].scale.x, 0.05);
  auto poses = InFrame<geometry_msgs::PoseArray>();
  poses.poses.resize(2);
  EXPECT_THAT(ShownOf(poses, axes).at(0).points, SizeIs(12));
  EXPECT_EQ(ShownOf(InFrame<geometry_msgs::PoseWithCovarianceStamped>()).at(0).type, Marker::ARROW);
}

TEST(ShownMessages, APolygonIsClosed) {
  auto polygon = InFrame<geometry_msgs::PolygonStamped>();
  polygon.polygon.points.resize(3);
  polygon.polygon.points[0].x = 2;
  const ShownMarkers markers = ShownOf(polygon);
  ASSERT_THAT(markers.at(0).points, SizeIs(4));
  EXPECT_EQ(markers[0].points.front(), markers[0].points.back());
  polygon.polygon.points.resize(1);
  EXPECT_EQ(ShownOf(polygon).at(0).action, Marker::DELETE);
}

TEST(ShownMessages, CellsAreSquaresAroundTheirPlaces) {
  auto grid = InFrame<nav_msgs::GridCells>();
  grid.cell_width = 0.5F;
  grid.cell_height = 0.25F;
  grid.cells.resize(2);
  grid.cells[1].x = 3;
  grid.cells[1].z = 1;
  const ShownMarkers markers = ShownOf(grid);
  ASSERT_THAT(markers.at(0).points, SizeIs(12));
  EXPECT_DOUBLE_EQ(markers[0].points[6].x, 2.75);
  EXPECT_DOUBLE_EQ(markers[0].points[6].y, -0.125);
  EXPECT_DOUBLE_EQ(markers[0].points[6].z, 1);
}

nav_msgs::OccupancyGrid MapOf(std::uint32_t width, std::uint32_t height) {
  auto map = InFrame<nav_msgs::OccupancyGrid>();
  map.info.resolution = 0.5;
  map.info.origin.position.x = -7;
  map.info.origin.orientation.w = 1;
  map.info.width = width;
  map.info.height = height;
  map.data.resize(std::size_t{width} * height);
  return map;
}

// The area of the triangles of each colour, m^2.
std::map<std::array<int, 3>, double> AreasOf(const Marker& triangles) {
  std::map<std::array<int, 3>, double> areas;
  for (std::size_t i = 0; i + 2 < triangles.points.size(); i += 3) {
    const auto &a = triangles.points[i], &b = triangles.points[i + 1], &c = triangles.points[i + 2];
    areas[RgbOf(triangles.colors.at(i))] +=
        std::abs((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y)) / 2;
  }
  return areas;
}

TEST(ShownMessages, AMapHasItsCellsInColoursOfRviz) {
  nav_msgs::OccupancyGrid map = MapOf(4, 3);
  map.data[5] = map.data[9] = 100;  // a wall of two cells, (1, 1) and (1, 2)
  map.data[3] = -1;
  const ShownMarkers markers = ShownOf(map);
  ASSERT_THAT(markers, SizeIs(1));
  EXPECT_EQ(markers[0].pose.position.x, -7);
  EXPECT_EQ(markers[0].colors.at(0).a, 0.7F);
  const std::array<int, 3> free = {255, 255, 255}, wall = {0, 0, 0}, unknown = {112, 137, 134};
  const auto areas = AreasOf(markers[0]);
  EXPECT_THAT(areas, SizeIs(3));
  EXPECT_DOUBLE_EQ(areas.at(free), 9 * 0.25);
  EXPECT_DOUBLE_EQ(areas.at(wall), 2 * 0.25);
  EXPECT_DOUBLE_EQ(areas.at(unknown), 0.25);
  EXPECT_THAT(markers[0].points, SizeIs(6 * 5)) << "equal cells are joined";
  ShownStyle costs;
  costs.map_colors = MapColors::kCostmap;
  map.data[3] = 50;
  const auto of_costs = AreasOf(ShownOf(map, costs).at(0));
  EXPECT_THAT(of_costs, SizeIs(2)) << "no cost is transparent";
  EXPECT_DOUBLE_EQ(of_costs.at({255, 0, 255}), 2 * 0.25);
  EXPECT_DOUBLE_EQ(of_costs.at({127, 0, 128}), 0.25);
  ShownStyle raw;
  raw.map_colors = MapColors::kRaw;
  map.data[0] = -2;
  const auto of_numbers = AreasOf(ShownOf(map, raw).at(0));
  EXPECT_DOUBLE_EQ(of_numbers.at({100, 100, 100}), 2 * 0.25);
  EXPECT_DOUBLE_EQ(of_numbers.at({254, 254, 254}), 0.25);
}

TEST(ShownMessages, AMapOfManyCellsKeepsItsWallsAndItsSize) {
  nav_msgs::OccupancyGrid map = MapOf(401, 301);
  for (std::size_t i = 0; i < map.data.size(); i += 2) map.data[i] = 100;  // a chessboard
  const ShownMarkers markers = ShownOf(map);
  EXPECT_LE(markers.at(0).points.size(), 6 * kMostMapRectangles);
  const auto areas = AreasOf(markers[0]);
  ASSERT_THAT(areas, SizeIs(1));
  EXPECT_NEAR(areas.at({0, 0, 0}), 402 * 302 * 0.25, 1e-6) << "with the rest of the last cells";
}

TEST(ShownMessages, AMapThatLiesIsRefused) {
  const auto why = [](const nav_msgs::OccupancyGrid& map) {
    const auto markers = ToMarkers(map);
    return markers ? std::string() : markers.error().text;
  };
  nav_msgs::OccupancyGrid map = MapOf(4, 3);
  EXPECT_EQ(why(map), "");
  map.info.width = 0x80000000;
  map.info.height = 2;  // 0 in 32 bits
  EXPECT_EQ(why(map), "a map: it states more cells than it has");
  map.info.height = 0;
  EXPECT_EQ(ShownOf(map).at(0).action, Marker::DELETE);
  map = MapOf(4, 3);
  map.info.resolution = std::nanf("");
  EXPECT_EQ(why(map), "a map: its resolution is not above 0");
}

TEST(ShownMessages, APointCloudOfTheOldTypeHasItsIntensities) {
  auto cloud = InFrame<sensor_msgs::PointCloud>();
  cloud.points.resize(3);
  cloud.points[2].z = std::nanf("");
  cloud.channels.resize(1);
  cloud.channels[0].name = "intensity";
  cloud.channels[0].values = {1, 5, 9};
  const ShownMarkers markers = ShownOf(cloud);
  ASSERT_THAT(markers.at(0).points, SizeIs(2));
  EXPECT_EQ(RgbOf(markers[0].colors.at(0)), (std::array<int, 3>{255, 0, 0})) << "the least";
  cloud.channels[0].values.pop_back();
  EXPECT_THAT(ShownOf(cloud).at(0).colors, SizeIs(0)) << "not one for each point";
  const std::uint32_t orange = 0xff8000;
  float packed = 0;
  std::memcpy(&packed, &orange, sizeof packed);
  cloud.channels.push_back(cloud.channels[0]);
  cloud.channels[1].name = "rgb";
  cloud.channels[1].values = {packed, packed, packed};
  EXPECT_EQ(RgbOf(ShownOf(cloud).at(0).colors.at(1)), (std::array<int, 3>{255, 128, 0}));
  ShownStyle blue;
  blue.color = Rgb{0, 0, 1};
  EXPECT_THAT(ShownOf(cloud, blue).at(0).colors, SizeIs(0)) << "of the style";
}

TEST(GridMarker, HasTheLinesOfRviz) {
  ShownStyle style;
  const Marker plain = GridMarker("", style);
  EXPECT_THAT(plain.points, SizeIs(2 * 2 * 11)) << "ten cells have eleven lines each way";
  EXPECT_NEAR(plain.color.a, 0.5, 1e-6);
  style.size_m = 0.5;
  style.grid.cells = 4;
  style.grid.layers = 2;
  style.grid.plane = GridStyle::Plane::kXz;
  style.grid.offset = {10, 20, 30};
  style.color = Rgb{1, 0, 0};
  const Marker box = GridMarker("table", style);
  EXPECT_EQ(box.header.frame_id, "table");
  EXPECT_EQ(box.color.r, 1);
  EXPECT_THAT(box.points, SizeIs(2 * (2 * 5 * 3 + 5 * 5)));
  Eigen::AlignedBox3d extent;
  for (const auto& point : box.points) extent.extend(Eigen::Vector3d(point.x, point.y, point.z));
  EXPECT_TRUE(extent.min().isApprox(Eigen::Vector3d(9, 19.5, 29)));
  EXPECT_TRUE(extent.max().isApprox(Eigen::Vector3d(11, 20.5, 31)));
  style.grid = {};
  style.grid.cells = kMostLayeredCells;
  style.grid.layers = kMostGridLayers;
  EXPECT_LE(GridMarker("", style).points.size(), kMaxMarkerPoints);
}

TEST(ShownMessages, OtherTypesAreNone) {
  EXPECT_EQ(FindShownMessage(ros::message_traits::md5sum<visualization_msgs::Marker>()), nullptr);
  EXPECT_EQ(FindShownMessage(""), nullptr);
  EXPECT_THAT(NamesOfShownMessages(), HasSubstr("nav_msgs/Path, nav_msgs/Odometry"));
}

TEST(ShownMessages, TruncatedOnesAreRefused) {
  auto path = InFrame<nav_msgs::Path>();
  path.poses.resize(2);
  const std::vector<std::uint8_t> whole = BytesOfMessage(path);
  const auto convert = FindShownMessage(ros::message_traits::md5sum<nav_msgs::Path>());
  ASSERT_NE(convert, nullptr);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_FALSE(convert({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}, {}))
        << size;
  }
}

}  // namespace
}  // namespace kinescope::ros_bridge
