/// Interactive markers as RViz draws them, which nobody can move here: the markers of each control,
/// and the description as a title. They are moved and changed by messages that refer to those
/// before, so there is one object per topic. Markers have ids, but no namespace. One thread.
#pragma once

#include <visualization_msgs/InteractiveMarkerInit.h>
#include <visualization_msgs/InteractiveMarkerUpdate.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/graph_view.h"
#include "server/ros/shown_messages.h"

namespace kinescope::ros_bridge {

/// All that the servers of one topic have at a time, in markers.
inline constexpr std::size_t kMostInteractiveMarkers = 2'000;

class InteractiveMarkers {
 public:
  /// The whole of a server: what it does not have is deleted. Older than an update that was taken:
  /// it adds what no update spoke of.
  /// @param out  markers to add, change and delete are appended, also where something is refused
  [[nodiscard]] std::optional<Refusal> Take(
      const visualization_msgs::InteractiveMarkerInit& message, const ShownStyle& style,
      ShownMarkers& out);
  /// What has changed: new ones, other poses, and those that are gone.
  [[nodiscard]] std::optional<Refusal> Take(
      const visualization_msgs::InteractiveMarkerUpdate& message, const ShownStyle& style,
      ShownMarkers& out);

 private:
  struct Part {
    visualization_msgs::Marker marker;  // where it was when its control was made
    bool is_fixed = false;              // it moves, but does not turn
  };
  struct Shown {
    std_msgs::Header header;
    geometry_msgs::Pose first_pose;  // that of the parts
    std::vector<Part> parts;
  };
  struct Server {
    std::optional<std::uint64_t> init, update;  // numbers of the newest messages
    std::map<std::string, Shown> markers;       // by name
    std::set<std::string> changed;              // names in updates, until the whole is known
    // Of updates about markers that only the whole has, until it is known; by name.
    std::map<std::string, visualization_msgs::InteractiveMarkerPose> moves;
  };

  Server* Find(const std::string& id);  // null: there are too many
  std::optional<Refusal> Put(Server& server, visualization_msgs::InteractiveMarker message,
                             const ShownStyle& style, ShownMarkers& out);
  /// But for those whose names are in `without`.
  std::optional<Refusal> PutAll(Server& server,
                                const std::vector<visualization_msgs::InteractiveMarker>& markers,
                                const std::set<std::string>& without, const ShownStyle& style,
                                ShownMarkers& out);
  static void Move(Shown& shown, const visualization_msgs::InteractiveMarkerPose& to,
                   ShownMarkers& out);
  void Erase(Server& server, const std::string& name, ShownMarkers& out);
  void EraseAll(Server& server, ShownMarkers& out);
  int TakeId();

  std::map<std::string, Server> servers_;  // by the id that each of them states
  std::set<int> free_ids_;
  int next_id_ = 0;
};

}  // namespace kinescope::ros_bridge
