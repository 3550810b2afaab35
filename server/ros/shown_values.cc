// Measured values as points with a colour.
#include "server/ros/point_colors.h"
#include "server/ros/shown_messages.h"
#include "server/ros/shown_parts.h"

namespace kinescope::ros_bridge {
namespace {

constexpr double kSphereSize = 0.1;  // m

// What RViz's display of the type begins with.
PointScale ScaleOf(const char* field, double from, double to, bool is_inverted) {
  PointScale scale;
  scale.by = field;
  scale.from = from;
  scale.to = to;
  scale.is_inverted = is_inverted;
  return scale;
}

ShownMarkers ShowValue(const std_msgs::Header& header, double value, const PointScale& usual,
                       ShownStyle style) {
  if (!style.size_m) style.has_spheres = true;
  if (!style.scale) style.scale = usual;
  if (style.scale->by.empty()) style.scale->by = usual.by;
  visualization_msgs::Marker point = PointsOf(header, style, kSphereSize);
  if (!style.color && style.scale->by == usual.by) point.color = ColorsOf({value}, style).front();
  if (style.has_spheres) {
    point.type = visualization_msgs::Marker::SPHERE;  // rounder than one of many
  } else {
    point.points.push_back(PointAt(0, 0, 0));
  }
  return {point};
}

}  // namespace

Taken<ShownMarkers> ToMarkers(const sensor_msgs::Temperature& message, const ShownStyle& style) {
  return ShowValue(message.header, message.temperature, ScaleOf("temperature", 0, 100, true),
                   style);
}

Taken<ShownMarkers> ToMarkers(const sensor_msgs::Illuminance& message, const ShownStyle& style) {
  return ShowValue(message.header, message.illuminance, ScaleOf("illuminance", 0, 1000, false),
                   style);
}

Taken<ShownMarkers> ToMarkers(const sensor_msgs::FluidPressure& message, const ShownStyle& style) {
  return ShowValue(message.header, message.fluid_pressure,
                   ScaleOf("fluid_pressure", 98'000, 105'000, false), style);
}

Taken<ShownMarkers> ToMarkers(const sensor_msgs::RelativeHumidity& message,
                              const ShownStyle& style) {
  return ShowValue(message.header, message.relative_humidity,
                   ScaleOf("relative_humidity", 0, 1, false), style);
}

}  // namespace kinescope::ros_bridge
