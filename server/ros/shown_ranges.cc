// What a sensor of one distance sees, as a cone.
#include <cmath>
#include <limits>

#include "server/ros/shown_messages.h"
#include "server/ros/shown_parts.h"

namespace kinescope::ros_bridge {
namespace {

// As RViz has it: 0 outside of what the sensor measures, unless it tells only whether something is
// there, which is -inf.
double ShownRange(const sensor_msgs::Range& message) {
  if (message.min_range <= message.range && message.range <= message.max_range) {
    return static_cast<double>(message.range);
  }
  const bool is_fixed = message.min_range == message.max_range;
  const bool is_there = message.range == -std::numeric_limits<float>::infinity();
  return is_fixed && is_there ? static_cast<double>(message.min_range) : 0;
}

}  // namespace

Taken<ShownMarkers> ToMarkers(const sensor_msgs::Range& message, const ShownStyle& style) {
  constexpr int kSides = 32;
  const double range = ShownRange(message);
  const auto field = static_cast<double>(message.field_of_view);
  if (!(field >= 0 && field < M_PI)) {
    return tl::unexpected(Refusal{"cannot be drawn", "a field of view that is not from 0 to pi"});
  }
  const double radius = range * std::tan(field / 2);
  auto color = Color(255, 255, 255);
  color.a = 0.5F;
  // RViz draws its front alone. Of its front and its back, which every ray meets once, both
  // together are as opaque.
  std_msgs::ColorRGBA half = In(style, color);
  half.a = 1 - std::sqrt(1 - half.a);
  visualization_msgs::Marker cone = TrianglesOf(message.header, 0, half);
  if (!(range > 0 && radius > 0)) return OneOrNone(std::move(cone));
  const auto corner = [&](int i) {
    const double angle = 2 * M_PI * i / kSides;
    return PointAt(range, radius * std::cos(angle), radius * std::sin(angle));
  };
  for (int i = 0; i < kSides; ++i) {
    cone.points.insert(cone.points.end(), {corner(i), corner(i + 1), PointAt(0, 0, 0)});
    cone.points.insert(cone.points.end(), {corner(i + 1), corner(i), PointAt(range, 0, 0)});
  }
  return OneOrNone(std::move(cone));
}

}  // namespace kinescope::ros_bridge
