#include "server/ros/updated_maps.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

namespace kinescope::ros_bridge {
namespace {

using map_msgs::OccupancyGridUpdate;

std::string TextOfUpdate(const OccupancyGridUpdate& update) {
  return fmt::format("an update of {} x {} cells at ({}, {})", update.width, update.height,
                     update.x, update.y);
}

bool IsWithinMap(const OccupancyGridUpdate& update, const nav_msgs::MapMetaData& map) {
  const auto is_within = [](std::int64_t begin, std::int64_t count, std::int64_t most) {
    return begin >= 0 && begin + count <= most;
  };
  return is_within(update.x, update.width, map.width) &&
         is_within(update.y, update.height, map.height);
}

std::optional<Refusal> WhyNotApplied(const OccupancyGridUpdate& update,
                                     const nav_msgs::MapMetaData& map) {
  if (!IsWithinMap(update, map)) {
    return Refusal{"outside of the map", fmt::format("{}: the map has {} x {}",
                                                     TextOfUpdate(update), map.width, map.height)};
  }
  const std::uint64_t count = std::uint64_t{update.width} * update.height;
  if (update.data.size() != count) {
    return Refusal{"wrong number of cells",
                   fmt::format("{}: it has {} values, expected {}", TextOfUpdate(update),
                               update.data.size(), count)};
  }
  return std::nullopt;
}

void CopyCells(const OccupancyGridUpdate& update, nav_msgs::OccupancyGrid& map) {
  if (update.data.empty()) return;  // of any number of rows
  const auto left = static_cast<std::size_t>(update.x), top = static_cast<std::size_t>(update.y);
  for (std::size_t row = 0; row < update.height; ++row) {
    std::copy_n(update.data.data() + row * update.width, update.width,
                map.data.data() + (top + row) * map.info.width + left);
  }
}

}  // namespace

Taken<ShownMarkers> UpdatedMaps::Put(std::size_t topic, nav_msgs::OccupancyGrid map,
                                     const ShownStyle& style) {
  Taken<ShownMarkers> markers = ToMarkers(map, style);
  if (markers) {
    maps_[topic] = std::move(map);
  } else {
    maps_.erase(topic);
  }
  return markers;
}

Taken<ShownMarkers> UpdatedMaps::Update(std::size_t topic, const OccupancyGridUpdate& update,
                                        const ShownStyle& style) {
  const auto known = maps_.find(topic);
  if (known == maps_.end()) {
    return tl::unexpected(Refusal{"no map yet", TextOfUpdate(update) + ": no map yet"});
  }
  nav_msgs::OccupancyGrid& map = known->second;
  if (const auto refusal = WhyNotApplied(update, map.info)) return tl::unexpected(*refusal);
  CopyCells(update, map);
  map.header.stamp = update.header.stamp;
  return ToMarkers(map, style);
}

}  // namespace kinescope::ros_bridge
