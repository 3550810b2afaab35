#include "server/ros/shown_parts.h"

#include <spdlog/fmt/fmt.h>

#include <utility>

namespace kinescope::ros_bridge {

using visualization_msgs::Marker;

std_msgs::ColorRGBA Color(int red, int green, int blue) {
  std_msgs::ColorRGBA color;
  color.r = static_cast<float>(red) / 255;
  color.g = static_cast<float>(green) / 255;
  color.b = static_cast<float>(blue) / 255;
  color.a = 1;
  return color;
}

std_msgs::ColorRGBA ColorOfAxis(int axis) {
  return Color(axis == 0 ? 255 : 0, axis == 1 ? 255 : 0, axis == 2 ? 255 : 0);
}

std_msgs::ColorRGBA In(const ShownStyle& style, std_msgs::ColorRGBA color) {
  if (style.color) {
    color.r = static_cast<float>((*style.color)[0]);
    color.g = static_cast<float>((*style.color)[1]);
    color.b = static_cast<float>((*style.color)[2]);
  }
  if (style.alpha) color.a = static_cast<float>(*style.alpha);
  return color;
}

Marker MarkerOf(const std_msgs::Header& header, int id, int type,
                const std_msgs::ColorRGBA& color) {
  Marker marker;
  marker.header = header;
  marker.id = id;
  marker.type = type;
  marker.action = Marker::ADD;
  marker.pose.orientation.w = 1;
  marker.color = color;
  return marker;
}

Marker TrianglesOf(const std_msgs::Header& header, int id, const std_msgs::ColorRGBA& color) {
  Marker triangles = MarkerOf(header, id, Marker::TRIANGLE_LIST, color);
  triangles.scale.x = triangles.scale.y = triangles.scale.z = 1;
  return triangles;
}

Marker Without(const std_msgs::Header& header, int id) {
  Marker marker;
  marker.header = header;
  marker.id = id;
  marker.action = Marker::DELETE;
  return marker;
}

Marker PointsOf(const std_msgs::Header& header, const ShownStyle& style, double size) {
  const int shape = style.has_spheres ? Marker::SPHERE_LIST
                    : style.has_cubes ? Marker::CUBE_LIST
                                      : Marker::POINTS;
  Marker points = MarkerOf(header, 0, shape, In(style, Color(255, 255, 255)));
  points.scale.x = points.scale.y = points.scale.z = style.size_m.value_or(size);
  return points;
}

ShownMarkers PointsOrNone(Marker points) {
  // They have sixty and six times the triangles of squares.
  constexpr std::size_t kMostSpheres = 500, kMostCubes = 5'000;
  const std::size_t most = points.type == Marker::SPHERE_LIST ? kMostSpheres : kMostCubes;
  if (points.points.size() > most) points.type = Marker::POINTS;
  return OneOrNone(std::move(points));
}

geometry_msgs::Point PointAt(double x, double y, double z) {
  geometry_msgs::Point point;
  point.x = x;
  point.y = y;
  point.z = z;
  return point;
}

geometry_msgs::Point PointAt(const Eigen::Vector3d& at) { return PointAt(at.x(), at.y(), at.z()); }

Eigen::Vector3d PositionOf(const geometry_msgs::Pose& pose) {
  return {pose.position.x, pose.position.y, pose.position.z};
}

Eigen::Quaterniond TurnOf(const geometry_msgs::Pose& pose) {
  Eigen::Quaterniond turn(pose.orientation.w, pose.orientation.x, pose.orientation.y,
                          pose.orientation.z);
  if (turn.norm() == 0) turn.setIdentity();
  turn.normalize();
  return turn;
}

geometry_msgs::Pose PoseAt(const Eigen::Vector3d& position, const Eigen::Quaterniond& turn) {
  geometry_msgs::Pose pose;
  pose.position = PointAt(position);
  pose.orientation.w = turn.w();
  pose.orientation.x = turn.x();
  pose.orientation.y = turn.y();
  pose.orientation.z = turn.z();
  return pose;
}

Marker LineOf(const std_msgs::Header& header, const ShownStyle& style) {
  Marker line = MarkerOf(header, 0, Marker::LINE_STRIP, In(style, Color(25, 255, 0)));
  line.scale.x = style.size_m.value_or(0.02);
  return line;
}

tl::unexpected<Refusal> TooLarge(const char* what, std::size_t count, std::size_t most) {
  return tl::unexpected(
      Refusal{"too large", fmt::format("{} {}: expected at most {}", count, what, most)});
}

ShownMarkers OneOrNone(Marker marker) {
  if (marker.points.empty()) return {Without(marker.header, marker.id)};
  return {std::move(marker)};
}

}  // namespace kinescope::ros_bridge
