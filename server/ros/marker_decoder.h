/// Converts messages of the topics that are shown: markers, messages that are shown as markers,
/// images and calibrations. A large cloud takes longer than a sample may wait, so this is done on a
/// thread of its own (marker_topics.h), and where messages come faster than that, the newest of a
/// topic takes the place of those before it. One thread.
#pragma once

#include <ros/message_event.h>
#include <visualization_msgs/Marker.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/camera_image.h"
#include "core/graph_view.h"
#include "server/ros/calibration.h"
#include "server/ros/marker_look.h"
#include "server/ros/raw_message.h"
#include "server/ros/topic_markers.h"

namespace kinescope::ros_bridge {

/// What a message has, or why it has nothing.
struct DecodedMessage {
  std::size_t topic = 0;
  std::int64_t monotonic_nanos = 0;  // when it came
  ShownMarkers markers = {};
  MarkerLook look = {};
  bool has_single_markers = false;  // each counts as a message
  std::optional<CameraImage> image = {};
  std::optional<Calibration> calibration = {};
  std::optional<Refusal> refusal = {};  // the rest is used all the same
  bool is_end = false;                  // no message: what there was of the topic is erased
};

class MarkerDecoder {
 public:
  using Event = RawEvent;

  MarkerDecoder(std::vector<ShownTopic> topics, FindJoint find)
      : topics_(std::move(topics)), shown_(std::move(find)) {}

  /// Decodes it, or keeps it for DecodeKept().
  /// @param has_colors  of HeardTopic
  void OnMessage(std::size_t topic, const Event& event, bool has_colors,
                 std::int64_t monotonic_nanos);
  /// Decodes what is kept, and once more what lacked something that may have come.
  void DecodeKept(std::int64_t monotonic_nanos);

  /// Of the calls since the last one.
  std::vector<DecodedMessage> Take() { return std::exchange(decoded_, {}); }

 private:
  struct Kept {
    Event event;
    std::int64_t monotonic_nanos = 0;
  };

  /// Since a message of the topic lacked something that may come.
  struct Early {
    std::int64_t since_nanos = 0;
    std::optional<Kept> newest = {};
  };

  /// Decodes it, or keeps it where it lacks something that may come.
  void Add(std::size_t topic, const Kept& message, bool has_colors, std::int64_t now_nanos);
  bool IsEarly(std::size_t topic, const Kept& message, const DecodedMessage& decoded,
               std::int64_t now_nanos);
  void Decode(std::size_t topic, const Event& event, bool has_colors, DecodedMessage& to);
  void DecodeMarkers(const RawMessage& raw, bool is_array, DecodedMessage& to);

  const std::vector<ShownTopic> topics_;
  TopicMarkers shown_;
  visualization_msgs::Marker marker_;                  // reused, keeps its memory
  visualization_msgs::MarkerArray array_;              // reused, keeps its memory
  std::map<std::pair<std::size_t, bool>, Kept> kept_;  // by topic and has_colors
  std::map<std::size_t, Early> early_;                 // by topic
  std::vector<DecodedMessage> decoded_;
};

}  // namespace kinescope::ros_bridge
