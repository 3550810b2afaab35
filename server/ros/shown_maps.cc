// Maps and cells as markers.
#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/scene_marker.h"
#include "server/ros/shown_messages.h"
#include "server/ros/shown_parts.h"

namespace kinescope::ros_bridge {
namespace {

using visualization_msgs::Marker;

// The two triangles of a rectangle in the plane z = 0.
void AddRectangle(double x, double y, double width, double height, Marker& triangles) {
  const auto corner = [&](double right, double up) {
    triangles.points.push_back(PointAt(x + right * width, y + up * height, 0));
  };
  for (const double side : {0.0, 1.0}) {
    corner(0, 0);
    corner(1, side);
    corner(1 - side, 1);
  }
}

// rviz/default_plugin/map_display.cpp; a cost of 0 is transparent.
std_msgs::ColorRGBA MapColor(std::int8_t cell, MapColors colors) {
  if (colors == MapColors::kRaw) {
    const int level = static_cast<std::uint8_t>(cell);
    return Color(level, level, level);
  }
  const bool is_costmap = colors == MapColors::kCostmap;
  if (cell >= 0 && cell <= 100) {
    const int level = 255 * cell / 100;
    if (!is_costmap) return Color(255 - level, 255 - level, 255 - level);
    if (cell < 99) return Color(level, 0, 255 - level);
    return cell == 99 ? Color(0, 255, 255) : Color(255, 0, 255);
  }
  if (cell > 100) return Color(0, 255, 0);
  if (cell == -1) return Color(112, 137, 134);
  return Color(255, 255 * (cell + 128) / 126, 0);
}

// Of a map whose cells are joined `step` by `step`: the most occupied, else free, else unknown.
class MapCells {
 public:
  MapCells(const nav_msgs::OccupancyGrid& map, std::uint32_t step)
      : map_(map),
        step_(step),
        width_(CountOf(map.info.width)),
        height_(CountOf(map.info.height)) {}

  std::uint32_t width() const { return width_; }
  std::uint32_t height() const { return height_; }
  std::int8_t At(std::uint32_t x, std::uint32_t y) const {
    std::int8_t most = std::numeric_limits<std::int8_t>::min();
    for (std::uint64_t row = std::uint64_t{y} * step_; row < End(y, map_.info.height); ++row) {
      for (std::uint64_t i = std::uint64_t{x} * step_; i < End(x, map_.info.width); ++i) {
        most = std::max(most, map_.data[row * map_.info.width + i]);
      }
    }
    return most;
  }

 private:
  std::uint32_t CountOf(std::uint32_t cells) const {
    return static_cast<std::uint32_t>((std::uint64_t{cells} + step_ - 1) / step_);
  }
  std::uint64_t End(std::uint32_t at, std::uint32_t cells) const {
    return std::min((std::uint64_t{at} + 1) * step_, std::uint64_t{cells});
  }

  const nav_msgs::OccupancyGrid& map_;
  const std::uint64_t step_;
  const std::uint32_t width_, height_;
};

struct MapRectangle {
  std::uint32_t x = 0, y = 0, width = 0, height = 0;  // cells
  std::int8_t cell = 0;
};

// Runs of equal cells, joined with equal ones of the row before; nullopt: there are too many.
std::optional<std::vector<MapRectangle>> RectanglesOf(const MapCells& cells) {
  std::vector<MapRectangle> all;
  std::vector<std::size_t> above, now;  // the rectangles of a row, by x
  for (std::uint32_t y = 0; y < cells.height(); ++y) {
    now.clear();
    auto before = above.begin();
    for (std::uint32_t x = 0; x < cells.width();) {
      MapRectangle run = {x, y, 0, 1, cells.At(x, y)};
      do {
        ++x;
      } while (x < cells.width() && cells.At(x, y) == run.cell);
      run.width = x - run.x;
      while (before != above.end() && all[*before].x < run.x) ++before;
      const bool goes_on = before != above.end() && all[*before].x == run.x &&
                           all[*before].width == run.width && all[*before].cell == run.cell;
      if (goes_on) {
        ++all[*before].height;
        now.push_back(*before);
        continue;
      }
      if (all.size() == kMostMapRectangles) return std::nullopt;
      now.push_back(all.size());
      all.push_back(run);
    }
    std::swap(above, now);
  }
  return all;
}

}  // namespace

Taken<ShownMarkers> ToMarkers(const nav_msgs::GridCells& message, const ShownStyle& style) {
  constexpr std::size_t kCorners = 6;
  if (message.cells.size() > kMaxMarkerPoints / kCorners) {
    return TooLarge("cells", message.cells.size(), kMaxMarkerPoints / kCorners);
  }
  Marker cells = TrianglesOf(message.header, 0, In(style, Color(25, 255, 0)));
  const auto width = static_cast<double>(message.cell_width),
             height = static_cast<double>(message.cell_height);
  for (const geometry_msgs::Point& cell : message.cells) {
    AddRectangle(cell.x - width / 2, cell.y - height / 2, width, height, cells);
    for (std::size_t i = cells.points.size() - kCorners; i < cells.points.size(); ++i) {
      cells.points[i].z += cell.z;
    }
  }
  return OneOrNone(std::move(cells));
}

Taken<ShownMarkers> ToMarkers(const nav_msgs::OccupancyGrid& message, const ShownStyle& style) {
  const nav_msgs::MapMetaData& info = message.info;
  const std::uint64_t count = std::uint64_t{info.width} * info.height;
  if (count > message.data.size() || !(info.resolution > 0)) {
    return tl::unexpected(Refusal{"cannot be drawn", count > message.data.size()
                                                         ? "a map: it states more cells than it has"
                                                         : "a map: its resolution is not above 0"});
  }
  if (count == 0) return ShownMarkers{Without(message.header, 0)};
  std::uint32_t step = 1;
  std::optional<std::vector<MapRectangle>> rectangles;
  while (!(rectangles = RectanglesOf(MapCells(message, step)))) step *= 2;
  ShownStyle seen_through = style;
  seen_through.color.reset();
  seen_through.alpha = style.alpha.value_or(0.7);
  Marker map = TrianglesOf(message.header, 0, Color(255, 255, 255));
  map.pose = info.origin;
  const double metres = static_cast<double>(info.resolution) * step;
  for (const MapRectangle& each : *rectangles) {
    if (style.map_colors == MapColors::kCostmap && each.cell == 0) continue;
    AddRectangle(each.x * metres, each.y * metres, each.width * metres, each.height * metres, map);
    map.colors.resize(map.points.size(), In(seen_through, MapColor(each.cell, style.map_colors)));
  }
  return OneOrNone(std::move(map));
}

}  // namespace kinescope::ros_bridge
