// Publishes one marker of each type, but for the mesh, on /samples, and says `published` on its
// standard output when a subscriber is there; a robot's URDF as /arm_description, and where its
// links are on /tf_static; a picture on /lab/image_raw. With a line on its standard input, the
// robot goes to another place and the markers away; with the next one, they are back. Until the end
// of its standard input.
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstdint>
#include <iostream>
#include <string>

#include "tests/render/marker_samples.h"

namespace kinescope {
namespace {

visualization_msgs::Marker ToMessage(const SceneMarker& marker) {
  visualization_msgs::Marker message;
  message.header.frame_id = "world";
  message.ns = marker.ns;
  message.id = marker.id;
  message.type = static_cast<int>(marker.type);
  const Eigen::Quaterniond& turn = marker.pose.orientation;
  message.pose.position.x = marker.pose.position.x();
  message.pose.position.y = marker.pose.position.y();
  message.pose.position.z = marker.pose.position.z();
  message.pose.orientation.x = turn.x();
  message.pose.orientation.y = turn.y();
  message.pose.orientation.z = turn.z();
  message.pose.orientation.w = turn.w();
  message.scale.x = marker.scale.x();
  message.scale.y = marker.scale.y();
  message.scale.z = marker.scale.z();
  const auto color = [](const Eigen::Vector4d& from) {
    std_msgs::ColorRGBA to;
    to.r = static_cast<float>(from.x());
    to.g = static_cast<float>(from.y());
    to.b = static_cast<float>(from.z());
    to.a = static_cast<float>(from.w());
    return to;
  };
  message.color = color(marker.color);
  for (const Eigen::Vector3d& point : marker.points) {
    message.points.emplace_back();
    message.points.back().x = point.x();
    message.points.back().y = point.y();
    message.points.back().z = point.z();
  }
  for (const Eigen::Vector4d& each : marker.colors) message.colors.push_back(color(each));
  message.text = marker.text;
  return message;
}

constexpr char kCameraFrame[] = "lab_eye";
constexpr char kArm[] =
    "<robot name='arm'><link name='arm_base'><visual><geometry><cylinder radius='0.08' "
    "length='0.5'/></geometry></visual></link><link name='arm_hand'><visual><geometry><box "
    "size='0.1 0.3 0.1'/></geometry></visual></link><joint name='arm_joint' type='revolute'>"
    "<parent link='arm_base'/><child link='arm_hand'/><axis xyz='1 0 0'/>"
    "<limit lower='-1' upper='1' effort='1' velocity='1'/></joint></robot>";

tf2_msgs::TFMessage PlacesOfArm(double x) {
  tf2_msgs::TFMessage message;
  message.transforms.resize(3);
  auto& base = message.transforms[0];
  base.header.frame_id = "world";
  base.child_frame_id = "arm_base";
  base.transform.translation.x = x;
  base.transform.translation.y = -0.45;
  base.transform.translation.z = 1.2;
  base.transform.rotation.w = 1;
  auto& hand = message.transforms[1];
  hand.header.frame_id = "arm_base";
  hand.child_frame_id = "arm_hand";
  hand.transform.translation.z = 0.35;
  hand.transform.rotation.x = 0.3826834;  // 45 degrees
  hand.transform.rotation.w = 0.9238795;
  auto& camera = message.transforms[2];  // before the person: z towards them, y down
  camera.header.frame_id = "world";
  camera.child_frame_id = kCameraFrame;
  camera.transform.translation.x = 2.6;
  camera.transform.translation.z = 1;
  camera.transform.rotation.x = camera.transform.rotation.y = -0.5;
  camera.transform.rotation.z = camera.transform.rotation.w = 0.5;
  return message;
}

sensor_msgs::CameraInfo Calibration() {
  sensor_msgs::CameraInfo info;
  info.header.frame_id = kCameraFrame;
  info.width = 160;
  info.height = 120;
  info.P = {140, 0, 74.5, 0, 0, 140, 62.5, 0, 0, 0, 1, 0};
  return info;
}

// Its left half is orange.
sensor_msgs::Image Picture() {
  sensor_msgs::Image image;
  image.header.frame_id = kCameraFrame;
  image.width = 160;
  image.height = 120;
  image.encoding = "rgb8";
  image.step = 3 * image.width;
  for (std::uint32_t i = 0; i < image.width * image.height; ++i) {
    const bool is_left = i % image.width < image.width / 2;
    image.data.insert(image.data.end(), {255, is_left ? std::uint8_t{120} : std::uint8_t{255},
                                         is_left ? std::uint8_t{0} : std::uint8_t{255}});
  }
  return image;
}

int Main(int argc, char** argv) {
  ros::init(argc, argv, "marker_publisher");
  ros::NodeHandle node;
  node.setParam("/arm_description", kArm);
  const ros::Publisher places = node.advertise<tf2_msgs::TFMessage>("/tf_static", 1, true);
  places.publish(PlacesOfArm(0.2));
  const ros::Publisher camera = node.advertise<sensor_msgs::Image>("/lab/image_raw", 1, true);
  camera.publish(Picture());
  const ros::Publisher info = node.advertise<sensor_msgs::CameraInfo>("/lab/camera_info", 1, true);
  info.publish(Calibration());
  visualization_msgs::MarkerArray array;
  for (const SceneMarker& marker : testing::MarkersOfAllTypes("")) {
    if (marker.type != MarkerType::kMesh) array.markers.push_back(ToMessage(marker));
  }
  const ros::Publisher publisher = node.advertise<visualization_msgs::MarkerArray>(
      "/samples", 1,
      [](const ros::SingleSubscriberPublisher&) { std::cout << "published" << std::endl; }, {}, {},
      /*latch=*/true);
  publisher.publish(array);
  ros::AsyncSpinner spinner(1);
  spinner.start();
  std::string line;
  visualization_msgs::MarkerArray none;
  none.markers.resize(1);
  none.markers[0].action = visualization_msgs::Marker::DELETEALL;
  for (bool is_there = false; std::getline(std::cin, line); is_there = !is_there) {
    publisher.publish(is_there ? array : none);
    places.publish(PlacesOfArm(is_there ? 0.2 : -1.5));
  }
  return 0;
}

}  // namespace
}  // namespace kinescope

int main(int argc, char** argv) { return kinescope::Main(argc, argv); }
