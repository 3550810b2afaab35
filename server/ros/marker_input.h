/// Converts external markers (visualization_msgs/Marker) to SceneMarkers: applies their actions
/// (add, change, delete), lifetimes and frames. No node, time is an argument, and a store belongs
/// to one thread. Actions, and the members that count for each type, are as in RViz
/// (wiki.ros.org/rviz/DisplayTypes/Marker).
#pragma once

#include <visualization_msgs/Marker.h>

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/graph_view.h"
#include "core/scene_marker.h"
#include "server/ros/force_input.h"
#include "server/ros/frame_ways.h"
#include "server/ros/marker_look.h"
#include "server/ros/marker_message.h"
#include "server/ros/now.h"
#include "server/ros/shown_marker.h"

namespace kinescope::ros_bridge {

inline constexpr std::size_t kMaxMarkers = 4096;           // of all topics
inline constexpr std::size_t kMaxPointsOfAll = 1'000'000;  // of all markers

class MarkerStore {
 public:
  /// reference_frame <- frame at a time; stamp 0: the newest. nullopt: not known (yet).
  using FindFrame =
      std::function<std::optional<FramePlace>(const std::string& frame, std::int64_t stamp_nanos)>;
  using Markers = std::vector<std::shared_ptr<const SceneMarker>>;

  /// `topic` identifies the sender: namespaces and ids of markers are separate per topic. Points
  /// that `style` colours by an axis have their colours as soon as they have a place; those of the
  /// type POINTS have its size in pixels (`size_px`), if it has one; markers of a namespace that it
  /// leaves out (`frames.hidden`) have no effect. With a `sweep` each point stands where the frame
  /// was when it was measured, by the places of the frame at the beginning and at the end.
  /// @return why the message, or a part of it, was rejected; nullopt if it was applied.
  [[nodiscard]] std::optional<Refusal> Apply(std::size_t topic,
                                             const visualization_msgs::Marker& message,
                                             const Now& now, const ShownStyle& style = {},
                                             const MarkerLook& look = {},
                                             std::shared_ptr<const Sweep> sweep = nullptr);

  /// All of them, with their sweeps. @return why the first of those that were rejected was
  template <class Message>
  [[nodiscard]] std::optional<Refusal> ApplyAll(std::size_t topic,
                                                const std::vector<Message>& messages,
                                                const Now& now, const ShownStyle& style = {},
                                                const MarkerLook& look = {}) {
    std::optional<Refusal> first;
    for (const Message& message : messages) {
      auto refusal = Apply(topic, message, now, style, look, SweepOf(message));
      if (refusal && !first) first = std::move(refusal);
    }
    return first;
  }

  /// Puts the axes of a frame, or a grid in it, into the store, for good. @pre frame.is_frame
  /// @throws UsageError if they cannot be shown
  void AddOfFrame(std::size_t topic, const ShownTopic& frame);

  /// Removes expired markers and transforms the others: once, or repeatedly if locked to their
  /// frame, but in at most a tenth of the time. A marker that is newer than the transforms of its
  /// frame waits for half a second, while the one before it stays, then stands by the newest one
  /// until they have come. Unknown frames are looked up ten times per second. True if the list of
  /// `markers()` has changed.
  [[nodiscard]] bool Update(const Now& now, const FindFrame& find_frame);

  /// The time of the graph was set back, as a recording that begins again does: forgets the markers
  /// of messages, as RViz, but not those of its new beginning, which may be here already.
  void StartAgain(const Now& now);

  /// Looks all frames up again: the reference frame is another one.
  void PlaceAgain();
  /// The frame of the first marker of a message that names one; "": there is none.
  [[nodiscard]] std::string FirstFrame() const;

  /// All markers with a known frame, in the order of topic, namespace and id.
  const Markers& markers() const { return placed_; }

  /// Markers that lost their place, or were added without one, since the last call.
  [[nodiscard]] std::vector<WithoutPlace> TakeLost();
  /// Those that have no place now; one for each topic and frame.
  [[nodiscard]] std::vector<WithoutPlace> Unplaced() const;

 private:
  using Key = std::tuple<std::size_t, std::string, int>;  // topic, namespace, id
  // A message that waits for transforms of its time.
  struct Waiting {
    std::shared_ptr<const SceneMarker> shape;
    std::string frame;
    std::int64_t stamp_nanos = 0;
    std::optional<ShownStyle> axis_style;
    std::shared_ptr<const Sweep> sweep;  // of the points of `shape`; null: none
  };
  struct Entry {
    std::shared_ptr<const SceneMarker> shape;         // of the newest message; its pose in `frame`
    std::shared_ptr<const SceneMarker> placed;        // in the world frame; null: not yet
    std::shared_ptr<const SceneMarker> placed_shape;  // of the message that it is of
    std::deque<Waiting> waiting;                      // messages before the newest
    std::string frame;
    std::optional<ShownStyle> axis_style;  // of points that are coloured by their place
    std::shared_ptr<const Sweep> sweep;    // of the points of `shape`; null: none
    bool is_placed_bent = false;           // by a sweep
    std::int64_t stamp_nanos = 0;
    bool is_locked = false;
    bool is_new = true;                                     // the newest message was not placed yet
    bool is_of_frame = false;                               // of no message
    bool stands_in_scene = false, is_told_missing = false;  // as ShownStyle has it
    bool is_lost = false;
    bool is_early = false;  // it stands by a transform that is older than its message
    std::int64_t came_nanos = 0;
    std::optional<std::int64_t> held_nanos;     // since then it waits for transforms of its time
    std::optional<std::int64_t> gave_up_nanos;  // then it had waited in vain
    std::int64_t lives_nanos = 0;               // 0: for ever
    std::int64_t dies_nanos = 0;                // clock of the graph; 0: never
  };

  class FrameCache;
  // Of a frame.
  struct Span {
    FramePlace first;                // at the stamp of a message
    std::optional<urdf::Pose> last;  // at the end of its sweep, if it is elsewhere then
  };
  bool Place(const Key& key, Entry& entry, FrameCache& frames, const Now& now);
  static bool IsHeld(Entry& entry, const FramePlace& place, std::int64_t now_nanos);
  void KeepWaiting(Entry& entry);
  /// The first `count` of those that wait.
  void StopWaiting(Entry& entry, std::size_t count);
  void Release(Entry& entry);
  bool PlaceWaiting(Entry& entry, FrameCache& frames, std::int64_t now_nanos);
  static bool PutAt(Entry& entry, const Waiting& message, const Span& place);
  static WithoutPlace LostOf(const Key& key, const Entry& entry);

  std::map<Key, Entry> entries_;
  std::size_t points_ = 0;          // in all entries
  std::size_t waiting_points_ = 0;  // in messages that wait
  bool has_changed_ = false;
  bool has_new_ = false;               // since Update() looked last
  std::int64_t next_look_nanos_ = 0;   // monotonic clock; at those of which none is new
  std::int64_t next_move_nanos_ = 0;   // monotonic clock; of markers locked to their frame
  std::int64_t next_retry_nanos_ = 0;  // monotonic clock; of markers without a place
  Markers placed_;
  std::vector<WithoutPlace> lost_;
};

}  // namespace kinescope::ros_bridge
