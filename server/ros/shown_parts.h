/// What the functions of shown_messages.h have in common. Pure functions, any thread.
#pragma once

#include <geometry_msgs/Point.h>
#include <std_msgs/ColorRGBA.h>
#include <std_msgs/Header.h>
#include <visualization_msgs/Marker.h>

#include <cstddef>

#include "core/graph_view.h"
#include "server/ros/shown_messages.h"

namespace kinescope::ros_bridge {

/// Of 0 to 255 each; opaque.
std_msgs::ColorRGBA Color(int red, int green, int blue);
/// `color`, unless the style has another one.
std_msgs::ColorRGBA In(const ShownStyle& style, std_msgs::ColorRGBA color);
visualization_msgs::Marker MarkerOf(const std_msgs::Header& header, int id, int type,
                                    const std_msgs::ColorRGBA& color);
/// Deletes the marker of this id.
visualization_msgs::Marker Without(const std_msgs::Header& header, int id);
/// Deletes it if it has no points.
ShownMarkers OneOrNone(visualization_msgs::Marker marker);
/// Without points yet: squares, spheres or cubes, of `size`, or the size of the style, m.
visualization_msgs::Marker PointsOf(const std_msgs::Header& header, const ShownStyle& style,
                                    double size);
/// Deletes it if it has no points; of many points, squares take the place of spheres and cubes.
ShownMarkers PointsOrNone(visualization_msgs::Marker points);
geometry_msgs::Point PointAt(double x, double y, double z);
tl::unexpected<Refusal> TooLarge(const char* what, std::size_t count, std::size_t most);

}  // namespace kinescope::ros_bridge
