// Wrenches, twists and accelerations as two arrows each, and RViz's ring about the second.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "server/ros/shown_messages.h"
#include "server/ros/shown_parts.h"
#include "urdf/turn_between.h"

namespace kinescope::ros_bridge {
namespace {

using Eigen::Vector3d;
using visualization_msgs::Marker;

enum Id : int { kLinear, kAngular, kRing, kHeadOfRing };

// RViz's arrow: a shaft of the length 1 and a head of 0.3.
constexpr double kWholeArrow = 1.3;

// Of one kind of vectors: how long the arrow is for 1, and from which value there is one.
struct Usual {
  double metres, least;
};

Vector3d FromRos(const geometry_msgs::Vector3& v) { return {v.x, v.y, v.z}; }

// Its length is not 0.
Marker ArrowOf(const std_msgs::Header& header, int id, const std_msgs::ColorRGBA& color,
               const Vector3d& to, const std::optional<double>& width) {
  Marker arrow = MarkerOf(header, id, Marker::ARROW, color);
  arrow.points = {PointAt(Vector3d(0, 0, 0)), PointAt(to)};
  if (width) {
    arrow.scale.x = 0.1 * *width;
    arrow.scale.y = 0.2 * *width;
    arrow.scale.z = to.norm() * (1 - 1 / kWholeArrow);
    return arrow;
  }
  arrow.scale.x = 0.018;  // diameters, as arrows of ground reaction forces (force_arrows)
  arrow.scale.y = 0.048;
  arrow.scale.z = std::min(0.06, 0.6 * to.norm());
  return arrow;
}

// @param to  where the arrow of the vector ends
bool IsSmall(const ShownStyle& style, const Vector3d& value, const Vector3d& to,
             const Usual& usual) {
  if (!style.width_m) return value.norm() < usual.least;
  return style.wrench.hides_small && to.norm() <= kWholeArrow * *style.width_m;
}

// Seven eighths of a turn about the arrow, at half of its shaft, that end in a head.
void AddRing(const std_msgs::Header& header, const std_msgs::ColorRGBA& color, const Vector3d& to,
             double width, ShownMarkers& markers) {
  constexpr int kParts = 32, kFirst = 4;
  const double shaft = to.norm() / kWholeArrow;
  const auto turn = urdf::TurnBetween(Vector3d::UnitZ(), to);
  Marker ring = MarkerOf(header, kRing, Marker::LINE_STRIP, color);
  ring.scale.x = 0.05 * width;
  for (int i = kFirst; i <= kParts; ++i) {
    const double angle = 2 * M_PI * i / kParts;
    ring.points.push_back(PointAt(
        turn * Vector3d(shaft / 4 * std::cos(angle), shaft / 4 * std::sin(angle), shaft / 2)));
  }
  const Vector3d end(shaft / 4, 0, shaft / 2);
  Marker head = MarkerOf(header, kHeadOfRing, Marker::ARROW, color);
  head.points = {PointAt(turn * end), PointAt(turn * (end + Vector3d(0, 0.1 * width, 0)))};
  head.scale.x = 0.05 * width;
  head.scale.y = 0.2 * width;
  head.scale.z = 0.1 * width;  // all of it
  markers.push_back(ring);
  markers.push_back(head);
}

ShownMarkers ShowArrows(const std_msgs::Header& header, const geometry_msgs::Vector3& linear,
                        const geometry_msgs::Vector3& angular, const Usual& of_linear,
                        const Usual& of_angular, const ShownStyle& style) {
  const WrenchArrows& arrows = style.wrench;
  ShownStyle second = style;
  if (arrows.torque_color) second.color = arrows.torque_color;
  ShownMarkers markers;
  // What is not finite goes on, so that it is named as for other markers.
  const Vector3d first_value = FromRos(linear), second_value = FromRos(angular);
  const Vector3d first_to = arrows.force_m.value_or(of_linear.metres) * first_value;
  const Vector3d second_to = arrows.torque_m.value_or(of_angular.metres) * second_value;
  const bool has_first = !IsSmall(style, first_value, first_to, of_linear) && first_to.norm() != 0;
  const bool has_second =
      !IsSmall(style, second_value, second_to, of_angular) && second_to.norm() != 0;
  markers.push_back(
      has_first ? ArrowOf(header, kLinear, In(style, Color(204, 51, 51)), first_to, style.width_m)
                : Without(header, kLinear));
  const std_msgs::ColorRGBA color = In(second, Color(204, 204, 51));
  markers.push_back(has_second ? ArrowOf(header, kAngular, color, second_to, style.width_m)
                               : Without(header, kAngular));
  if (!style.width_m) return markers;
  if (has_second && second_to.allFinite()) {
    AddRing(header, color, second_to, *style.width_m, markers);
  } else {
    markers.push_back(Without(header, kRing));
    markers.push_back(Without(header, kHeadOfRing));
  }
  return markers;
}

}  // namespace

Taken<ShownMarkers> ToMarkers(const geometry_msgs::WrenchStamped& message,
                              const ShownStyle& style) {
  return ShowArrows(message.header, message.wrench.force, message.wrench.torque, {0.001, 5},
                    {0.01, 0.5}, style);
}

Taken<ShownMarkers> ToMarkers(const geometry_msgs::TwistStamped& message, const ShownStyle& style) {
  return ShowArrows(message.header, message.twist.linear, message.twist.angular, {1, 0.01},
                    {1, 0.01}, style);
}

Taken<ShownMarkers> ToMarkers(const geometry_msgs::AccelStamped& message, const ShownStyle& style) {
  return ShowArrows(message.header, message.accel.linear, message.accel.angular, {0.1, 0.1},
                    {0.1, 0.1}, style);
}

}  // namespace kinescope::ros_bridge
