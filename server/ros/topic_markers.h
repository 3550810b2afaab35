/// What the messages of topics leave to be shown: the markers of each, beside those of the messages
/// before it that stay. One thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/graph_view.h"
#include "server/ros/depth_clouds.h"
#include "server/ros/earlier_messages.h"
#include "server/ros/effort_rings.h"
#include "server/ros/interactive_markers.h"
#include "server/ros/marker_look.h"
#include "server/ros/shown_messages.h"
#include "server/ros/updated_maps.h"

namespace kinescope::ros_bridge {

class TopicMarkers {
 public:
  /// @param find  the joints of robots whose efforts are shown; empty: there are none
  explicit TopicMarkers(FindJoint find = {}) : find_joint_(std::move(find)) {}

  /// Whether messages of this type are shown as markers, or say how others are: of a cloud of
  /// depths, the calibration; of a map, its updates.
  static bool IsShown(const std::string& md5sum, const ShownStyle& style);

  /// Of the markers of such messages. @pre IsShown(md5sum, style)
  static MarkerLook LookOf(const std::string& md5sum, const ShownStyle& style);

  /// Of a message of topic number `topic`, in a namespace as a legend has it: "plan" for "/plan",
  /// "goals" for "/goals/update" of interactive markers. @pre IsShown(md5sum, style)
  /// @param out  markers to add, change and delete are appended, also where something is refused
  [[nodiscard]] std::optional<Refusal> Take(std::size_t topic, const std::string& name,
                                            const ShownStyle& style, const std::string& md5sum,
                                            const std::vector<std::uint8_t>& bytes,
                                            ShownMarkers& out);

  /// An image with the colours of the next cloud of depths.
  [[nodiscard]] std::optional<Refusal> TakeColors(std::size_t topic, const std::string& md5sum,
                                                  const std::vector<std::uint8_t>& bytes);

 private:
  Taken<ShownMarkers> ToMarkersOf(std::size_t topic, const ShownStyle& style,
                                  const std::string& md5sum,
                                  const std::vector<std::uint8_t>& bytes);
  Taken<ShownMarkers> TakeDepths(std::size_t topic, const ShownStyle& style,
                                 const std::string& md5sum, const std::vector<std::uint8_t>& bytes);
  Taken<ShownMarkers> TakeMap(std::size_t topic, const ShownStyle& style, const std::string& md5sum,
                              const std::vector<std::uint8_t>& bytes);

  const FindJoint find_joint_;
  MessageShelf shelf_;
  std::map<std::size_t, InteractiveMarkers> interactive_;  // by topic
  DepthClouds clouds_;
  UpdatedMaps maps_;
};

/// A topic that is heard for one that is shown.
struct HeardTopic {
  std::string name;
  bool has_colors = false;  // of a cloud of depths
};
/// The topic itself, and those beside it: of a server of interactive markers, "<name>/update_full"
/// beside "<name>/update", which has all that it shows; of images, the calibration of their camera
/// where the scene is drawn over them; of depths, the calibration and the colours; if the style has
/// them, "<name>_array" beside single markers and "<name>_updates" beside a map.
std::vector<HeardTopic> TopicsHeardFor(const ShownTopic& shown);

/// "geometry_msgs/PointStamped, ..."
std::string NamesOfShownTypes();

}  // namespace kinescope::ros_bridge
