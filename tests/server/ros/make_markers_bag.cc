// make_markers_bag FILE: writes the recording of golden_images/markers.yaml, a person at a work
// place that another node marks: a bag of half a second, with /tf and /workplace.
#include <rosbag/bag.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstdio>
#include <string>

#include "server/ros/transforms.h"
#include "server/scene/scene_reader.h"

namespace {

using namespace kinescope;
using ros_bridge::PersonNames;
using visualization_msgs::Marker;

constexpr std::int64_t kBegin = 1'600'000'000'000'000'000;  // ns
constexpr int kSamples = 30;                                // at 60 Hz
constexpr int kFirst = 75;                                  // of the motion: the person bends

Marker Shape(int id, int type, double x, double y, double z, double width, double depth,
             double height) {
  Marker marker;
  marker.header.frame_id = "workplace";
  marker.ns = "workplace";
  marker.id = id;
  marker.type = type;
  marker.pose.position.x = x;
  marker.pose.position.y = y;
  marker.pose.position.z = z;
  marker.pose.orientation.w = 1;
  marker.scale.x = width;
  marker.scale.y = depth;
  marker.scale.z = height;
  marker.color.r = 0.25F;
  marker.color.g = 0.45F;
  marker.color.b = 0.7F;
  marker.color.a = 1;
  return marker;
}

visualization_msgs::MarkerArray Workplace() {
  visualization_msgs::MarkerArray all;
  all.markers.push_back(Shape(1, Marker::CUBE, 0.85, 0, 0.175, 0.4, 1, 0.35));
  all.markers.push_back(Shape(2, Marker::CYLINDER, 0.8, 0.3, 0.45, 0.16, 0.16, 0.2));
  all.markers.push_back(Shape(3, Marker::SPHERE, 0.8, -0.3, 0.43, 0.16, 0.16, 0.16));
  all.markers.push_back(Shape(4, Marker::TEXT_VIEW_FACING, 0.85, 0, 0.62, 0, 0, 0.07));
  all.markers.back().text = "shelf";
  Marker path = Shape(5, Marker::LINE_STRIP, 0, 0, 0.01, 0.02, 0, 0);
  for (int i = 0; i <= 16; ++i) {
    geometry_msgs::Point point;
    point.x = -1 + 1.4 * i / 16;
    point.y = -0.9 + 0.9 * i * i / 256;
    path.points.push_back(point);
  }
  all.markers.push_back(path);
  Marker arrow = Shape(6, Marker::ARROW, 0, 0.9, 0.6, 0.5, 0.04, 0.04);
  arrow.ns = "way";
  arrow.color.r = 0.6F;
  all.markers.push_back(arrow);
  return all;
}

ros::Time TimeOf(std::int64_t nanos) {
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(nanos));
  return time;
}

// The place is turned a little, so that its frame matters.
tf2_msgs::TFMessage PlaceOfTheWorkplace() {
  tf2_msgs::TFMessage message;
  message.transforms.resize(1);
  auto& transform = message.transforms.front();
  transform.header.frame_id = "world";
  transform.header.stamp = TimeOf(kBegin);
  transform.child_frame_id = "workplace";
  transform.transform.rotation.z = 0.0871557;  // 10 degrees
  transform.transform.rotation.w = 0.9961947;
  return message;
}

void Write(const std::string& path) {
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  bag.setCompression(rosbag::compression::BZ2);
  bag.write("/tf_static", TimeOf(kBegin - 2), PlaceOfTheWorkplace());
  bag.write("/workplace", TimeOf(kBegin - 1), Workplace());
  app::SceneReader reader("demo:lift", app::SceneOptions());
  tf2_msgs::TFMessage message;
  for (int number = 0; number < kFirst + kSamples; ++number) {
    const auto state = reader.Next();
    if (number < kFirst) continue;
    PersonState person = state->people.at(0);
    const std::int64_t now = kBegin + (number - kFirst) * std::int64_t{16'666'667};
    person.sample.stamp_nanos = now;
    FillTransforms(person, PersonNames("skeleton"), "world", ros_bridge::TfShape::kFlat, message);
    message.transforms.resize(urdf::kSegmentCount);  // without the links inside joints
    bag.write("/tf", TimeOf(now), message);
  }
  bag.close();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: make_markers_bag FILE\n");
    return 2;
  }
  Write(argv[1]);
  return 0;
}
