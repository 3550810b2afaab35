/// What the messages of topics leave to be shown: the markers of each, beside those of the messages
/// before it that stay. One thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/graph_view.h"
#include "server/ros/earlier_messages.h"
#include "server/ros/interactive_markers.h"
#include "server/ros/shown_messages.h"

namespace kinescope::ros_bridge {

class TopicMarkers {
 public:
  /// Whether messages of this type are shown as markers.
  static bool IsShown(const std::string& md5sum);

  /// Of a message of topic number `topic`, in a namespace as a legend has it: "plan" for "/plan",
  /// "goals" for "/goals/update" of interactive markers. @pre IsShown(md5sum)
  /// @param out  markers to add, change and delete are appended, also where something is refused
  [[nodiscard]] std::optional<Refusal> Take(std::size_t topic, const std::string& name,
                                            const ShownStyle& style, const std::string& md5sum,
                                            const std::vector<std::uint8_t>& bytes,
                                            ShownMarkers& out);

 private:
  MessageShelf shelf_;
  std::map<std::size_t, InteractiveMarkers> interactive_;  // by topic
};

/// A server of interactive markers has a topic "<name>/update" and beside it this one, which has
/// all that it shows; "": `topic` is not the former.
std::string TopicOfAll(const std::string& topic);

/// "geometry_msgs/PointStamped, ..."
std::string NamesOfShownTypes();

}  // namespace kinescope::ros_bridge
