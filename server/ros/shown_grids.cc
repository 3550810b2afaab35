#include <algorithm>
#include <array>

#include "core/scene_marker.h"
#include "server/ros/shown_messages.h"
#include "server/ros/shown_parts.h"

namespace kinescope::ros_bridge {
namespace {

using Eigen::Vector3d;
using visualization_msgs::Marker;

// The directions of a plane, and that across it.
std::array<Vector3d, 3> DirectionsOf(GridStyle::Plane plane) {
  switch (plane) {
    case GridStyle::Plane::kXz: return {Vector3d::UnitX(), Vector3d::UnitZ(), Vector3d::UnitY()};
    case GridStyle::Plane::kYz: return {Vector3d::UnitY(), Vector3d::UnitZ(), Vector3d::UnitX()};
    case GridStyle::Plane::kXy: break;
  }
  return {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
}

}  // namespace

Marker GridMarker(const std::string& frame, const ShownStyle& style) {
  const GridStyle& grid = style.grid;
  const double cell = style.size_m.value_or(1);
  std_msgs::Header header;
  header.frame_id = frame;
  std_msgs::ColorRGBA color = In(style, Color(160, 160, 164));
  color.a = static_cast<float>(style.alpha.value_or(0.5));
  Marker lines = MarkerOf(header, 0, Marker::LINE_LIST, color);
  lines.ns = kNamespaceOfGrids;
  lines.frame_locked = 1U;                    // it goes with its frame
  lines.scale.x = style.width_m.value_or(1);  // else in pixels
  const auto [right, ahead, up] = DirectionsOf(grid.plane);
  const Vector3d middle(grid.offset[0], grid.offset[1], grid.offset[2]);
  const auto at = [&, &right = right, &ahead = ahead, &up = up](int x, int y, int z) {
    return PointAt(middle + cell * ((x - 0.5 * grid.cells) * right +
                                    (y - 0.5 * grid.cells) * ahead + (z - 0.5 * grid.layers) * up));
  };
  for (int z = 0; z <= grid.layers; ++z) {
    for (int i = 0; i <= grid.cells; ++i) {
      for (const auto& end :
           {at(i, 0, z), at(i, grid.cells, z), at(0, i, z), at(grid.cells, i, z)}) {
        lines.points.push_back(end);
      }
    }
  }
  for (int x = 0; grid.layers > 0 && x <= grid.cells; ++x) {
    for (int y = 0; y <= grid.cells; ++y) {
      lines.points.push_back(at(x, y, 0));
      lines.points.push_back(at(x, y, grid.layers));
    }
  }
  return lines;
}

}  // namespace kinescope::ros_bridge
