/// Maps of which parts are replaced by updates: RViz's Map. One thread.
#pragma once

#include <map_msgs/OccupancyGridUpdate.h>
#include <nav_msgs/OccupancyGrid.h>

#include <cstddef>
#include <map>

#include "core/graph_view.h"
#include "server/ros/force_input.h"
#include "server/ros/shown_messages.h"

namespace kinescope::ros_bridge {

class UpdatedMaps {
 public:
  /// The markers of a map, which is kept for its updates in place of the one before. If it cannot
  /// be drawn, none is kept.
  Taken<ShownMarkers> Put(std::size_t topic, nav_msgs::OccupancyGrid map, const ShownStyle& style);

  /// The markers of the whole map with the cells of the update, at its time and in the frame of the
  /// map. Or why it cannot be applied; then the map stays as it is.
  Taken<ShownMarkers> Update(std::size_t topic, const map_msgs::OccupancyGridUpdate& update,
                             const ShownStyle& style);

 private:
  std::map<std::size_t, nav_msgs::OccupancyGrid> maps_;  // the newest, by topic
};

}  // namespace kinescope::ros_bridge
