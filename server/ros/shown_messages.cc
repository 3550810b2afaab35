#include "server/ros/shown_messages.h"

#include <ros/message_traits.h>
#include <spdlog/fmt/fmt.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <array>
#include <utility>

#include "core/scene_marker.h"
#include "server/ros/raw_message.h"
#include "server/ros/shown_parts.h"

namespace kinescope::ros_bridge {
namespace {

using visualization_msgs::Marker;

Marker LineOf(const std_msgs::Header& header, const ShownStyle& style) {
  Marker line = MarkerOf(header, 0, Marker::LINE_STRIP, In(style, Color(25, 255, 0)));
  line.scale.x = style.size_m.value_or(0.02);
  return line;
}

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

// Red, green and blue for x, y and z. @param width  of its lines
void AddAxes(const geometry_msgs::Pose& pose, double length, double width, const ShownStyle& style,
             Marker& lines) {
  lines.scale.x = width;
  const Eigen::Vector3d at = PositionOf(pose);
  const Eigen::Matrix3d axes = length * TurnOf(pose).toRotationMatrix();
  ShownStyle translucent;
  translucent.alpha = style.alpha;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d tip = at + axes.col(i);
    lines.points.push_back(PointAt(at.x(), at.y(), at.z()));
    lines.points.push_back(PointAt(tip.x(), tip.y(), tip.z()));
    const auto color = In(translucent, Color(i == 0 ? 255 : 0, i == 1 ? 255 : 0, i == 2 ? 255 : 0));
    lines.colors.insert(lines.colors.end(), 2, color);
  }
}

// The line and the axes of its poses as one marker, which has one name in a legend.
Marker WithAxes(const Marker& line, const nav_msgs::Path& path, double length,
                const ShownStyle& style) {
  Marker lines = line;
  lines.type = Marker::LINE_LIST;
  lines.points.clear();
  for (std::size_t i = 1; i < line.points.size(); ++i) {
    lines.points.insert(lines.points.end(), {line.points[i - 1], line.points[i]});
  }
  lines.colors.assign(lines.points.size(), line.color);
  for (const geometry_msgs::PoseStamped& each : path.poses) {
    AddAxes(each.pose, length, line.scale.x, style, lines);
  }
  return lines;
}

ShownMarkers ShowPose(const std_msgs::Header& header, const geometry_msgs::Pose& pose,
                      const ShownStyle& style) {
  if (style.has_axes) {
    const double length = style.size_m.value_or(1);
    Marker lines = MarkerOf(header, 0, Marker::LINE_LIST, Color(255, 255, 255));
    AddAxes(pose, length, 0.1 * length, style, lines);
    return {lines};
  }
  constexpr double kLength = 1.3;
  const double length = style.size_m.value_or(kLength), share = length / kLength;
  Marker arrow = MarkerOf(header, 0, Marker::ARROW, In(style, Color(255, 25, 0)));
  arrow.pose = pose;
  arrow.points = {PointAt(0, 0, 0), PointAt(length, 0, 0)};
  arrow.scale.x = 0.05 * share;  // RViz's "radius" is a diameter
  arrow.scale.y = 0.1 * share;
  arrow.scale.z = 0.3 * share;
  return {arrow};
}

// The ellipsoid of one standard deviation, of the position alone; flat if z has none, as in RViz.
Marker EllipsoidOf(const std_msgs::Header& header, const geometry_msgs::PoseWithCovariance& pose,
                   const CovarianceStyle& style) {
  constexpr double kThin = 0.001;  // of the others
  constexpr std::size_t kRow = 6;
  Eigen::Matrix3d covariance;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      covariance(static_cast<int>(i), static_cast<int>(k)) =
          (pose.covariance[kRow * i + k] + pose.covariance[kRow * k + i]) / 2;
    }
  }
  if (!covariance.allFinite()) return Without(header, 1);
  const bool is_flat = covariance(2, 2) <= 0;
  if (is_flat) covariance.row(2).setZero();
  if (is_flat) covariance.col(2).setZero();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  Eigen::Vector3d diameters = 2 * style.scale * solver.eigenvalues().cwiseMax(0).cwiseSqrt();
  if (!(diameters.maxCoeff() > 0)) return Without(header, 1);
  diameters = diameters.cwiseMax(kThin * diameters.maxCoeff());
  Eigen::Matrix3d turn = solver.eigenvectors();
  if (turn.determinant() < 0) turn.col(0) *= -1;
  const Eigen::Quaterniond q(turn);
  Marker ellipsoid = MarkerOf(header, 1, Marker::SPHERE, Color(204, 51, 204));
  ShownStyle colors;
  colors.color = style.color;
  colors.alpha = style.alpha;
  ellipsoid.color = In(colors, ellipsoid.color);
  ellipsoid.pose.position = pose.pose.position;
  ellipsoid.pose.orientation.w = q.w();
  ellipsoid.pose.orientation.x = q.x();
  ellipsoid.pose.orientation.y = q.y();
  ellipsoid.pose.orientation.z = q.z();
  ellipsoid.scale.x = diameters.x();
  ellipsoid.scale.y = diameters.y();
  ellipsoid.scale.z = diameters.z();
  return ellipsoid;
}

ShownMarkers ShowPose(const std_msgs::Header& header, const geometry_msgs::PoseWithCovariance& pose,
                      const ShownStyle& style) {
  ShownMarkers markers = ShowPose(header, pose.pose, style);
  if (style.covariance.scale > 0) markers.push_back(EllipsoidOf(header, pose, style.covariance));
  return markers;
}

}  // namespace

Taken<ShownMarkers> ToMarkers(const geometry_msgs::PointStamped& message, const ShownStyle& style) {
  Marker sphere = MarkerOf(message.header, 0, Marker::SPHERE, In(style, Color(204, 41, 204)));
  sphere.pose.position = message.point;
  sphere.scale.x = sphere.scale.y = sphere.scale.z = 2 * style.size_m.value_or(0.2);
  return ShownMarkers{sphere};
}

Taken<ShownMarkers> ToMarkers(const geometry_msgs::PoseStamped& message, const ShownStyle& style) {
  return ShowPose(message.header, message.pose, style);
}

Taken<ShownMarkers> ToMarkers(const geometry_msgs::PoseWithCovarianceStamped& message,
                              const ShownStyle& style) {
  return ShowPose(message.header, message.pose, style);
}

Taken<ShownMarkers> ToMarkers(const nav_msgs::Odometry& message, const ShownStyle& style) {
  return ShowPose(message.header, message.pose, style);
}

Taken<ShownMarkers> ToMarkers(const geometry_msgs::PoseArray& message, const ShownStyle& style) {
  const double length = style.size_m.value_or(0.3);
  constexpr std::size_t kCorners = 6;
  if (message.poses.size() > kMaxMarkerPoints / kCorners) {
    return TooLarge("poses", message.poses.size(), kMaxMarkerPoints / kCorners);
  }
  Marker lines = MarkerOf(message.header, 0, Marker::LINE_LIST, In(style, Color(255, 25, 0)));
  lines.scale.x = 0.006;
  for (const geometry_msgs::Pose& pose : message.poses) {
    if (style.has_axes) {
      AddAxes(pose, length, length / 30, style, lines);
      continue;
    }
    const Eigen::Vector3d at = PositionOf(pose);
    const Eigen::Quaterniond turn = TurnOf(pose);
    const auto corner = [&](double x, double y) {
      const Eigen::Vector3d place = at + turn * Eigen::Vector3d(length * x, length * y, 0);
      lines.points.push_back(PointAt(place.x(), place.y(), place.z()));
    };
    corner(0, 0);
    corner(1, 0);
    for (const double side : {1.0, -1.0}) {
      corner(1, 0);
      corner(0.75, 0.2 * side);
    }
  }
  return OneOrNone(std::move(lines));
}

Taken<ShownMarkers> ToMarkers(const nav_msgs::Path& message, const ShownStyle& style) {
  constexpr double kLength = 0.3;  // m, of axes
  constexpr std::size_t kPointsWithAxes = 8;
  const std::size_t most = kMaxMarkerPoints / (style.has_axes ? kPointsWithAxes : 1);
  if (message.poses.size() > most) return TooLarge("poses", message.poses.size(), most);
  Marker line = LineOf(message.header, style);
  for (const geometry_msgs::PoseStamped& each : message.poses) {
    line.points.push_back(each.pose.position);
  }
  if (style.has_axes) return OneOrNone(WithAxes(line, message, kLength, style));
  if (line.points.size() == 1) line.points.clear();  // no line
  return OneOrNone(std::move(line));
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

Marker AxesOf(const std::string& frame, const ShownStyle& style) {
  const double length = style.size_m.value_or(1);
  std_msgs::Header header;
  header.frame_id = frame;
  Marker lines = MarkerOf(header, 0, Marker::LINE_LIST, Color(255, 255, 255));
  lines.ns = frame.empty() ? "axes" : frame;
  lines.frame_locked = 1U;  // they go with their frame
  AddAxes({}, length, style.width_m.value_or(0.1 * length), style, lines);
  return lines;
}

ToMarkersOfBytes FindShownMessage(const std::string& md5sum) {
  for (const ShownType& type : ShownTypes()) {
    if (md5sum == type.md5sum) return type.to_markers;
  }
  return nullptr;
}

void NameByTopic(ShownMarkers& markers, const std::string& topic) {
  for (Marker& marker : markers) marker.ns = WithoutSlashes(topic);
}

std::string NamesOfShownMessages() {
  std::string names;
  for (const ShownType& type : ShownTypes())
    names += (names.empty() ? "" : ", ") + std::string(type.name);
  return names;
}

}  // namespace kinescope::ros_bridge
