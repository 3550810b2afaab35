#include "server/ros/earlier_messages.h"

namespace kinescope::ros_bridge {
namespace {

constexpr int kIdsPerMessage = 8;  // more than the markers of any message

}  // namespace

bool MessageShelf::IsNear(const EarlierMessages& earlier, const urdf::Pose& place,
                          const Shelf& shelf) {
  if (!shelf.last_place) return false;
  const urdf::Pose& last = *shelf.last_place;
  return (place.position - last.position).norm() < earlier.step_m &&
         place.orientation.angularDistance(last.orientation) < earlier.turn_rad;
}

bool MessageShelf::Place(std::size_t topic, const EarlierMessages& earlier, ShownMarkers& markers) {
  if (markers.empty()) return true;
  Shelf& shelf = shelves_[topic];
  const geometry_msgs::Pose& pose = markers.front().pose;
  const urdf::Pose place{{pose.position.x, pose.position.y, pose.position.z},
                         Eigen::Quaterniond(pose.orientation.w, pose.orientation.x,
                                            pose.orientation.y, pose.orientation.z)
                             .normalized()};
  if (IsNear(earlier, place, shelf)) return false;
  shelf.last_place = place;
  const bool decays = earlier.decay_secs > 0;
  const std::size_t kept = decays ? kMostKeptMessages : earlier.keep;
  const auto slot = static_cast<int>(shelf.count++ % kept);
  for (visualization_msgs::Marker& marker : markers) {
    marker.id += slot * kIdsPerMessage;
    if (decays) marker.lifetime.fromSec(earlier.decay_secs);
  }
  return true;
}

}  // namespace kinescope::ros_bridge
