// Poses, alone, in an array and along a path: as arrows or axes.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/scene_marker.h"
#include "server/ros/shown_messages.h"
#include "server/ros/shown_parts.h"

namespace kinescope::ros_bridge {
namespace {

using Eigen::Vector3d;
using visualization_msgs::Marker;

constexpr double kLengthInList = 0.3;  // m, of the arrows and axes of many poses

// Of an arrow along x: its shares of the whole length.
struct ArrowShape {
  double shaft, shaft_diameter, head_diameter;
};
// The usual ones of RViz's displays.
constexpr ArrowShape kArrowOfArray = {0.23 / 0.3, 0.01 / 0.3, 0.03 / 0.3};
constexpr ArrowShape kArrowOfPath = {0.1 / 0.3, 0.1 / 0.3, 1};

constexpr int kSidesOfArrow = 12;
constexpr std::size_t kPointsOfArrow = 5 * 3 * std::size_t{kSidesOfArrow};

// Red, green and blue for x, y and z. @param width  of its lines
void AddAxes(const geometry_msgs::Pose& pose, double length, double width, const ShownStyle& style,
             Marker& lines) {
  lines.scale.x = width;
  const Vector3d at = PositionOf(pose);
  const Eigen::Matrix3d axes = length * TurnOf(pose).toRotationMatrix();
  ShownStyle translucent;
  translucent.alpha = style.alpha;
  for (int i = 0; i < 3; ++i) {
    lines.points.push_back(PointAt(at));
    lines.points.push_back(PointAt(at + axes.col(i)));
    lines.colors.insert(lines.colors.end(), 2, In(translucent, ColorOfAxis(i)));
  }
}

ArrowShape ShapeOf(const ArrowShape& usual, double length, const ArrowStyle& style) {
  ArrowShape shape = usual;
  if (style.head_m) shape.shaft = std::max(0.0, 1 - *style.head_m / length);
  if (style.shaft_width_m) shape.shaft_diameter = *style.shaft_width_m / length;
  if (style.head_width_m) shape.head_diameter = *style.head_width_m / length;
  return shape;
}

// Triangles: of the shaft and its end, of the head and its base.
void AddArrow(const geometry_msgs::Pose& pose, double length, const ArrowShape& shape,
              Marker& triangles) {
  const Vector3d at = PositionOf(pose);
  const Eigen::Quaterniond turn = TurnOf(pose);
  const auto add = [&](const Vector3d& corner) {
    triangles.points.push_back(PointAt(at + turn * (length * corner)));
  };
  const auto on_ring = [](double x, double diameter, int i) {
    const double angle = 2 * M_PI * i / kSidesOfArrow;
    return Vector3d(x, diameter / 2 * std::cos(angle), diameter / 2 * std::sin(angle));
  };
  const Vector3d tail(0, 0, 0), neck(shape.shaft, 0, 0), tip(1, 0, 0);
  for (int i = 0; i < kSidesOfArrow; ++i) {
    const Vector3d back = on_ring(0, shape.shaft_diameter, i),
                   next_back = on_ring(0, shape.shaft_diameter, i + 1),
                   front = on_ring(shape.shaft, shape.shaft_diameter, i),
                   next_front = on_ring(shape.shaft, shape.shaft_diameter, i + 1),
                   rim = on_ring(shape.shaft, shape.head_diameter, i),
                   next_rim = on_ring(shape.shaft, shape.head_diameter, i + 1);
    for (const Vector3d& each : {tail, next_back, back, back, next_back, front, front, next_back,
                                 next_front, neck, next_rim, rim, rim, next_rim, tip}) {
      add(each);
    }
  }
}

// Three lines in the plane of x and y.
void AddFlatArrow(const geometry_msgs::Pose& pose, double length, Marker& lines) {
  const Vector3d at = PositionOf(pose);
  const Eigen::Quaterniond turn = TurnOf(pose);
  const auto corner = [&](double x, double y) {
    lines.points.push_back(PointAt(at + turn * Vector3d(length * x, length * y, 0)));
  };
  corner(0, 0);
  corner(1, 0);
  for (const double side : {1.0, -1.0}) {
    corner(1, 0);
    corner(0.75, 0.2 * side);
  }
}

ShownMarkers ShowPose(const std_msgs::Header& header, const geometry_msgs::Pose& pose,
                      const ShownStyle& style) {
  if (style.has_axes) {
    const double length = style.size_m.value_or(1);
    Marker lines = MarkerOf(header, 0, Marker::LINE_LIST, Color(255, 255, 255));
    lines.pose = pose;
    AddAxes({}, length, style.width_m.value_or(0.1 * length), style, lines);
    return {lines};
  }
  constexpr double kLength = 1.3;
  const double length = style.size_m.value_or(kLength), share = length / kLength;
  const ArrowStyle& shape = style.arrow;
  Marker arrow = MarkerOf(header, 0, Marker::ARROW, In(style, Color(255, 25, 0)));
  arrow.pose = pose;
  arrow.points = {PointAt(0, 0, 0), PointAt(length, 0, 0)};
  arrow.scale.x = shape.shaft_width_m.value_or(0.05 * share);  // RViz's "radius" is a diameter
  arrow.scale.y = shape.head_width_m.value_or(0.1 * share);
  arrow.scale.z = shape.head_m.value_or(0.3 * share);
  return {arrow};
}

ShownMarkers ShowPose(const std_msgs::Header& header, const geometry_msgs::PoseWithCovariance& pose,
                      const ShownStyle& style) {
  ShownMarkers markers = ShowPose(header, pose.pose, style);
  AddCovariances(header, pose, style, markers);
  return markers;
}

}  // namespace

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
  const double length = style.size_m.value_or(kLengthInList);
  constexpr std::size_t kCorners = 6;
  if (message.poses.size() > kMaxMarkerPoints / kCorners) {
    return TooLarge("poses", message.poses.size(), kMaxMarkerPoints / kCorners);
  }
  const std_msgs::ColorRGBA color = In(style, Color(255, 25, 0));
  if (style.has_arrows && message.poses.size() <= kMaxMarkerPoints / kPointsOfArrow) {
    Marker arrows = TrianglesOf(message.header, 0, color);
    const ArrowShape shape = ShapeOf(kArrowOfArray, length, style.arrow);
    for (const geometry_msgs::Pose& pose : message.poses) AddArrow(pose, length, shape, arrows);
    return OneOrNone(std::move(arrows));
  }
  Marker lines = MarkerOf(message.header, 0, Marker::LINE_LIST, color);
  lines.scale.x = 0.006;
  for (const geometry_msgs::Pose& pose : message.poses) {
    if (style.has_axes) {
      AddAxes(pose, length, style.width_m.value_or(length / 30), style, lines);
    } else {
      AddFlatArrow(pose, length, lines);
    }
  }
  return OneOrNone(std::move(lines));
}

Taken<ShownMarkers> ToMarkers(const nav_msgs::Path& message, const ShownStyle& style) {
  constexpr std::size_t kPointsWithAxes = 6;
  const std::size_t most = kMaxMarkerPoints / (style.has_axes     ? kPointsWithAxes
                                               : style.has_arrows ? kPointsOfArrow
                                                                  : 1);
  if (message.poses.size() > most) return TooLarge("poses", message.poses.size(), most);
  Marker line = LineOf(message.header, style);
  for (const geometry_msgs::PoseStamped& each : message.poses) {
    line.points.push_back(each.pose.position);
  }
  const double length = style.poses.size_m.value_or(kLengthInList);
  if (line.points.size() == 1) line.points.clear();  // no line
  ShownMarkers markers = OneOrNone(std::move(line));
  if (style.has_axes) {
    Marker axes = MarkerOf(message.header, 1, Marker::LINE_LIST, Color(255, 255, 255));
    const double width = style.poses.width_m.value_or(0.1 * length);
    for (const geometry_msgs::PoseStamped& each : message.poses) {
      AddAxes(each.pose, length, width, style, axes);
    }
    markers.push_back(OneOrNone(std::move(axes)).front());
    return markers;
  }
  if (!style.has_arrows) return markers;
  ShownStyle of_poses = style;
  of_poses.color = style.poses.color;
  Marker arrows = TrianglesOf(message.header, 1, In(of_poses, Color(255, 85, 255)));
  const ArrowShape shape = ShapeOf(kArrowOfPath, length, style.arrow);
  for (const geometry_msgs::PoseStamped& each : message.poses) {
    AddArrow(each.pose, length, shape, arrows);
  }
  markers.push_back(OneOrNone(std::move(arrows)).front());
  return markers;
}

Marker AxesMarker(const std::string& frame, const ShownStyle& style) {
  const double length = style.size_m.value_or(1);
  std_msgs::Header header;
  header.frame_id = frame;
  Marker lines = MarkerOf(header, 0, Marker::LINE_LIST, Color(255, 255, 255));
  lines.ns = kNamespaceOfAxes;
  lines.frame_locked = 1U;  // they go with their frame
  AddAxes({}, length, style.width_m.value_or(0.1 * length), style, lines);
  return lines;
}

}  // namespace kinescope::ros_bridge
