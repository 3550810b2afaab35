/// What the functions of shown_messages.h have in common. Pure functions, any thread.
#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/PoseWithCovariance.h>
#include <std_msgs/ColorRGBA.h>
#include <std_msgs/Header.h>
#include <visualization_msgs/Marker.h>

#include <Eigen/Geometry>
#include <cstddef>

#include "core/graph_view.h"
#include "server/ros/shown_messages.h"

namespace kinescope::ros_bridge {

/// Of 0 to 255 each; opaque.
std_msgs::ColorRGBA Color(int red, int green, int blue);
/// Red, green and blue for x (0), y and z.
std_msgs::ColorRGBA ColorOfAxis(int axis);
/// `color`, unless the style has another one.
std_msgs::ColorRGBA In(const ShownStyle& style, std_msgs::ColorRGBA color);
visualization_msgs::Marker MarkerOf(const std_msgs::Header& header, int id, int type,
                                    const std_msgs::ColorRGBA& color);
/// A list of triangles, without points yet, in metres.
visualization_msgs::Marker TrianglesOf(const std_msgs::Header& header, int id,
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
/// A line strip as those of paths, without points yet; 2 cm wide.
visualization_msgs::Marker LineOf(const std_msgs::Header& header, const ShownStyle& style);
/// The ellipsoid of the position's standard deviation: id 1. That of the orientation: ids 2 to 4.
/// What the style or the pose does not have is deleted.
void AddCovariances(const std_msgs::Header& header, const geometry_msgs::PoseWithCovariance& pose,
                    const ShownStyle& style, ShownMarkers& markers);
geometry_msgs::Point PointAt(double x, double y, double z);
geometry_msgs::Point PointAt(const Eigen::Vector3d& at);
Eigen::Vector3d PositionOf(const geometry_msgs::Pose& pose);
/// Normalised; of a message without an orientation, no turn.
Eigen::Quaterniond TurnOf(const geometry_msgs::Pose& pose);
geometry_msgs::Pose PoseAt(const Eigen::Vector3d& position, const Eigen::Quaterniond& turn);
tl::unexpected<Refusal> TooLarge(const char* what, std::size_t count, std::size_t most);

}  // namespace kinescope::ros_bridge
