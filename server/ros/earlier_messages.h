/// What stays of the messages before the newest one of a topic (EarlierMessages), by the ids and
/// lifetimes of their markers. One thread.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "core/graph_view.h"
#include "server/ros/shown_messages.h"
#include "urdf/kinematics.h"

namespace kinescope::ros_bridge {

class MessageShelf {
 public:
  /// Gives the markers of the newest message of topic number `topic` ids and lifetimes, so that
  /// they replace no more than they should. False: it is not shown, since it is as near to the one
  /// before as the style says.
  bool Place(std::size_t topic, const EarlierMessages& earlier, ShownMarkers& markers);

 private:
  struct Shelf {
    std::uint64_t count = 0;               // messages that were placed
    std::optional<urdf::Pose> last_place;  // of the last one
  };
  static bool IsNear(const EarlierMessages& earlier, const urdf::Pose& place, const Shelf& shelf);

  std::map<std::size_t, Shelf> shelves_;
};

}  // namespace kinescope::ros_bridge
