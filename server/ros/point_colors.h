/// Colours of points by a number that each of them has, as RViz's colour transformers Intensity and
/// AxisColor have them. Pure functions, any thread.
#pragma once

#include <std_msgs/ColorRGBA.h>

#include <optional>
#include <vector>

#include "core/graph_view.h"

namespace kinescope::ros_bridge {

/// The axis by which the style colours points (0: x), of the scene or of their message; nullopt:
/// by none.
std::optional<int> AxisOf(const ShownStyle& style);
/// The same, of the scene alone: it is known where the points are placed.
std::optional<int> SceneAxisOf(const ShownStyle& style);

/// One for each of `values`. Without a scale in the style: a rainbow from the least of them, red,
/// to the most, magenta. A value that is not finite has the colour of the least. Source:
/// rviz/default_plugin/point_cloud_transformers.cpp of RViz 1.14.
std::vector<std_msgs::ColorRGBA> ColorsOf(const std::vector<double>& values,
                                          const ShownStyle& style);

}  // namespace kinescope::ros_bridge
