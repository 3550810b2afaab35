#include "server/ros/shown_messages.h"

#include <ros/message_traits.h>
#include <spdlog/fmt/fmt.h>

#include <array>
#include <utility>

#include "core/scene_marker.h"
#include "server/ros/raw_message.h"
#include "server/ros/shown_parts.h"

namespace kinescope::ros_bridge {
namespace {

using visualization_msgs::Marker;

template <class Message>
Taken<ShownMarkers> OfBytes(const std::vector<std::uint8_t>& bytes, const ShownStyle& style) {
  Message message;
  if (!ReadBounded(bytes.data(), bytes.size(), message)) return tl::unexpected(Unreadable());
  return ToMarkers(message, style);
}

struct ShownType {
  const char* name;
  const char* md5sum;
  ToMarkersOfBytes to_markers;
};

template <class Message>
ShownType TypeOf() {
  return {ros::message_traits::datatype<Message>(), ros::message_traits::md5sum<Message>(),
          OfBytes<Message>};
}

const std::array<ShownType, 20>& ShownTypes() {
  static const std::array<ShownType, 20> kTypes = {
      TypeOf<geometry_msgs::PointStamped>(),
      TypeOf<geometry_msgs::PoseStamped>(),
      TypeOf<geometry_msgs::PoseWithCovarianceStamped>(),
      TypeOf<geometry_msgs::PoseArray>(),
      TypeOf<geometry_msgs::PolygonStamped>(),
      TypeOf<geometry_msgs::WrenchStamped>(),
      TypeOf<geometry_msgs::TwistStamped>(),
      TypeOf<geometry_msgs::AccelStamped>(),
      TypeOf<nav_msgs::Path>(),
      TypeOf<nav_msgs::Odometry>(),
      TypeOf<nav_msgs::GridCells>(),
      TypeOf<nav_msgs::OccupancyGrid>(),
      TypeOf<sensor_msgs::LaserScan>(),
      TypeOf<sensor_msgs::Range>(),
      TypeOf<sensor_msgs::PointCloud>(),
      TypeOf<sensor_msgs::PointCloud2>(),
      TypeOf<sensor_msgs::Temperature>(),
      TypeOf<sensor_msgs::Illuminance>(),
      TypeOf<sensor_msgs::FluidPressure>(),
      TypeOf<sensor_msgs::RelativeHumidity>()};
  return kTypes;
}

}  // namespace

Taken<ShownMarkers> ToMarkers(const geometry_msgs::PointStamped& message, const ShownStyle& style) {
  Marker sphere = MarkerOf(message.header, 0, Marker::SPHERE, In(style, Color(204, 41, 204)));
  sphere.pose.position = message.point;
  sphere.scale.x = sphere.scale.y = sphere.scale.z = 2 * style.size_m.value_or(0.2);
  return ShownMarkers{sphere};
}

Taken<ShownMarkers> ToMarkers(const geometry_msgs::PolygonStamped& message,
                              const ShownStyle& style) {
  const auto& corners = message.polygon.points;
  if (corners.size() >= kMaxMarkerPoints) {
    return TooLarge("corners", corners.size(), kMaxMarkerPoints - 1);
  }
  Marker line = LineOf(message.header, style);
  const auto add = [&](const geometry_msgs::Point32& corner) {
    line.points.push_back(PointAt(static_cast<double>(corner.x), static_cast<double>(corner.y),
                                  static_cast<double>(corner.z)));
  };
  if (corners.size() > 1) {
    for (const geometry_msgs::Point32& corner : corners) add(corner);
    add(corners.front());
  }
  return OneOrNone(std::move(line));
}

ToMarkersOfBytes FindShownMessage(const std::string& md5sum) {
  for (const ShownType& type : ShownTypes()) {
    if (md5sum == type.md5sum) return type.to_markers;
  }
  return nullptr;
}

std::string NamesOfShownMessages() {
  std::string names;
  for (const ShownType& type : ShownTypes())
    names += (names.empty() ? "" : ", ") + std::string(type.name);
  return names;
}

}  // namespace kinescope::ros_bridge
