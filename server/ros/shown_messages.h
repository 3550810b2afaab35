/// Messages of other nodes that RViz has displays for (poses, paths, points, wrenches, laser scans,
/// point clouds, maps), as markers: so they go the way of all external markers, to the page, to
/// pictures and to clips. Shapes and colours are the defaults of RViz 1.14, except where the
/// functions say otherwise. Pure functions, any thread.
#pragma once

#include <geometry_msgs/AccelStamped.h>
#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/PolygonStamped.h>
#include <geometry_msgs/PoseArray.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <nav_msgs/GridCells.h>
#include <nav_msgs/OccupancyGrid.h>
#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Illuminance.h>
#include <sensor_msgs/LaserScan.h>
#include <sensor_msgs/PointCloud.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/Range.h>
#include <sensor_msgs/RelativeHumidity.h>
#include <sensor_msgs/Temperature.h>
#include <visualization_msgs/Marker.h>

#include <cstdint>
#include <string>
#include <vector>

#include "core/graph_view.h"
#include "server/ros/force_input.h"
#include "server/ros/shown_marker.h"

namespace kinescope::ros_bridge {

inline constexpr std::size_t kMostMapRectangles = 4'000;

/// A sphere with a radius of 0.2 m.
Taken<ShownMarkers> ToMarkers(const geometry_msgs::PointStamped& message,
                              const ShownStyle& style = {});
/// An arrow of 1.3 m along x, or axes of 1 m.
Taken<ShownMarkers> ToMarkers(const geometry_msgs::PoseStamped& message,
                              const ShownStyle& style = {});
/// The same; with a covariance, the ellipsoid of one standard deviation of the position.
Taken<ShownMarkers> ToMarkers(const geometry_msgs::PoseWithCovarianceStamped& message,
                              const ShownStyle& style = {});
/// The same, of the newest pose alone.
Taken<ShownMarkers> ToMarkers(const nav_msgs::Odometry& message, const ShownStyle& style = {});
/// Flat arrows of 0.3 m; lines of 6 mm, because a marker has no width in pixels. Or axes of 0.3 m.
Taken<ShownMarkers> ToMarkers(const geometry_msgs::PoseArray& message,
                              const ShownStyle& style = {});
/// A line through the positions, in the frame of the path, as in RViz; 2 cm wide. With axes: of 0.3
/// m at each pose, too.
Taken<ShownMarkers> ToMarkers(const nav_msgs::Path& message, const ShownStyle& style = {});
/// Its edges, as a path has them.
Taken<ShownMarkers> ToMarkers(const geometry_msgs::PolygonStamped& message,
                              const ShownStyle& style = {});
/// Squares, 1 mm above their frame, because a floor lies at 0.
Taken<ShownMarkers> ToMarkers(const nav_msgs::GridCells& message, const ShownStyle& style = {});
/// Cells in the colours of RViz's scheme "map", 1 mm above their frame; of a map that has more than
/// kMostMapRectangles of equal cells, 2, 4, 8, ... of them are shown as one: the most occupied.
Taken<ShownMarkers> ToMarkers(const nav_msgs::OccupancyGrid& message, const ShownStyle& style = {});
/// An arrow of 1 m for 1000 N, as those of ground reaction forces, and one of 1 m for 100 N·m,
/// unless the style says otherwise; RViz's 2 m for 1 N are made for fingertips. Below 5 N or 0.5
/// N·m: none. With a width: shaft, head and the ring about a torque as RViz has them. A size is not
/// taken.
Taken<ShownMarkers> ToMarkers(const geometry_msgs::WrenchStamped& message,
                              const ShownStyle& style = {});
/// The same, of 1 m for 1 m/s and for 1 rad/s; below 0.01: none.
Taken<ShownMarkers> ToMarkers(const geometry_msgs::TwistStamped& message,
                              const ShownStyle& style = {});
/// The same, of 1 m for 10 m/s² and for 10 rad/s²; below 0.1: none.
Taken<ShownMarkers> ToMarkers(const geometry_msgs::AccelStamped& message,
                              const ShownStyle& style = {});
/// A translucent cone along x, as long as the range; none for a range that the sensor does not
/// have.
Taken<ShownMarkers> ToMarkers(const sensor_msgs::Range& message, const ShownStyle& style = {});
/// Points of 1 cm, coloured by intensity where the scan has it. By an axis of the scene only once
/// they have a place in it (marker_input.h). Of more than the style has, as many are shown: a
/// page gets 20 bytes for each, up to ten times a second.
Taken<ShownMarkers> ToMarkers(const sensor_msgs::LaserScan& message, const ShownStyle& style = {});
/// Points of 1 cm: by `rgb` or `rgba`, else by `intensity`, else white; with a scale by its field,
/// or white without that.
Taken<ShownMarkers> ToMarkers(const sensor_msgs::PointCloud2& message,
                              const ShownStyle& style = {});

Taken<ShownMarkers> ToMarkers(const sensor_msgs::PointCloud& message, const ShownStyle& style = {});

/// A sphere of 0.1 m, or a square of the size of the style, at the origin of its frame: in the
/// colour of the value, by default between the bounds of RViz's display of the type.
Taken<ShownMarkers> ToMarkers(const sensor_msgs::Temperature& message,
                              const ShownStyle& style = {});
Taken<ShownMarkers> ToMarkers(const sensor_msgs::Illuminance& message,
                              const ShownStyle& style = {});
Taken<ShownMarkers> ToMarkers(const sensor_msgs::FluidPressure& message,
                              const ShownStyle& style = {});
Taken<ShownMarkers> ToMarkers(const sensor_msgs::RelativeHumidity& message,
                              const ShownStyle& style = {});

/// Axes of 1 m, or of the size of the style, that go with a frame of TF; "": that of the scene.
visualization_msgs::Marker AxesMarker(const std::string& frame, const ShownStyle& style);

/// A grid that goes with a frame of TF; "": that of the scene. RViz's lines of one pixel are
/// 1 cm wide.
visualization_msgs::Marker GridMarker(const std::string& frame, const ShownStyle& style);

/// The markers of serialised bytes; or why there are none.
using ToMarkersOfBytes = Taken<ShownMarkers> (*)(const std::vector<std::uint8_t>& bytes,
                                                 const ShownStyle& style);
/// Null unless messages of this type are shown.
ToMarkersOfBytes FindShownMessage(const std::string& md5sum);

/// "geometry_msgs/PointStamped, ..."
std::string NamesOfShownMessages();

}  // namespace kinescope::ros_bridge
