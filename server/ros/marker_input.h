/// Markers of other programs: messages (visualization_msgs/Marker) -> SceneMarkers, what they ask
/// for with those before (add, change, delete), how long they live and where their frames are.
/// No node, time is an argument, and a store belongs to one thread. What an action means, and what
/// of a message counts for which type, is as RViz has it (wiki.ros.org/rviz/DisplayTypes/Marker).
#pragma once

#include <visualization_msgs/Marker.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "core/scene_marker.h"
#include "server/ros/force_input.h"

namespace kinescope::ros_bridge {

inline constexpr std::size_t kMostMarkers = 4096;           // of all topics
inline constexpr std::size_t kMostPointsOfAll = 1'000'000;  // of all markers
inline constexpr std::size_t kLongestMarkerName = 256;      // bytes, of a frame or a namespace

/// The shape alone, in the frame that the message names. A quaternion of zeros is no turn; any
/// other is brought to unit length. Points, colours, texts of types that have none are left out.
Taken<SceneMarker> ToSceneMarker(const visualization_msgs::Marker& message);

class MarkerStore {
 public:
  /// reference_frame <- frame at a time; stamp 0: the newest. nullopt: not known (yet).
  using FindFrame =
      std::function<std::optional<urdf::Pose>(const std::string& frame, std::int64_t stamp_nanos)>;
  using Markers = std::vector<std::shared_ptr<const SceneMarker>>;

  /// `topic` tells apart who sends: names and numbers of markers are a topic's own.
  /// @return why the message changes nothing; nullopt when it did what it asked for.
  [[nodiscard]] std::optional<Refusal> Apply(std::size_t topic,
                                             const visualization_msgs::Marker& message,
                                             std::int64_t monotonic_nanos);

  /// Lets go of what has lived its time and places the rest: once, or where it is locked to its
  /// frame, anew, though never so often that this takes a tenth of the time; a frame that is not
  /// known is asked for ten times a second. True when `markers()` is another list than before.
  [[nodiscard]] bool Update(std::int64_t monotonic_nanos, const FindFrame& find_frame);

  /// All that can be placed, in the order of topic, namespace and number.
  const Markers& markers() const { return placed_; }

  /// Those whose frame is not known: "walls/3 in frame 'map'", by topic, newest news only.
  struct Lost {
    std::size_t topic;
    std::string text;
  };
  /// What has lost, or never had, a place since the last call.
  [[nodiscard]] std::vector<Lost> TakeLost();

 private:
  using Key = std::tuple<std::size_t, std::string, int>;  // topic, namespace, number
  struct Entry {
    std::shared_ptr<const SceneMarker> shape;   // its pose in `frame`
    std::shared_ptr<const SceneMarker> placed;  // in the world; null: not yet
    std::string frame;
    std::int64_t stamp_nanos = 0;
    bool is_locked = false;
    bool is_new = true;  // its newest message has not found its place
    bool is_lost = false;
    std::int64_t dies_nanos = 0;  // monotonic; 0: never
  };

  class FrameCache;
  bool Place(const Key& key, Entry& entry, FrameCache& frames);

  std::map<Key, Entry> entries_;
  std::size_t points_ = 0;  // of all entries
  bool has_changed_ = false;
  std::int64_t next_move_nanos_ = 0;   // monotonic; of what is locked to its frame
  std::int64_t next_retry_nanos_ = 0;  // likewise, of what has no place
  Markers placed_;
  std::vector<Lost> lost_;
};

}  // namespace kinescope::ros_bridge
