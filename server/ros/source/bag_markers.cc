#include "server/ros/source/bag_markers.h"

#include <ros/message_traits.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "server/ros/markers.h"
#include "server/ros/raw_message.h"

namespace kinescope::ros_bridge {
namespace {

constexpr std::size_t kMostMarkerTopics = 256;
constexpr std::size_t kMostWarnings = 8;
constexpr char kUnreadableMarkers[] = "markers that are truncated or have a wrong length field";

bool IsOne(const BagConnection& connection) {
  return connection.md5sum == ros::message_traits::md5sum<visualization_msgs::Marker>();
}

bool IsArray(const BagConnection& connection) {
  return connection.md5sum == ros::message_traits::md5sum<visualization_msgs::MarkerArray>();
}

}  // namespace

bool BagMarkers::IsMarkers(const BagConnection& connection) {
  return IsOne(connection) || IsArray(connection);
}

// Into array_. Why it cannot be used, or null.
const char* BagMarkers::Decode(const BagMessage& message) {
  if (message.bytes.size() != message.size) return "markers of more than 16 MiB";
  if (IsArray(*message.connection)) {
    return kinescope::ros_bridge::Decode(message.bytes, array_) ? nullptr : kUnreadableMarkers;
  }
  if (!kinescope::ros_bridge::Decode(message.bytes, marker_)) return kUnreadableMarkers;
  array_.markers.assign(1, marker_);
  return nullptr;
}

void BagMarkers::Take(const BagMessage& message, SourceCounters& counters) {
  if (const char* const defect = Decode(message)) {
    ++counters.rejected[defect];
    return;
  }
  if (!array_.markers.empty() && IsOwnMarkerNamespace(array_.markers.front().ns)) {
    ++counters.ignored["markers of Kinescope"];
    return;
  }
  const std::string& topic = message.connection->topic;
  if (topics_.count(topic) == 0 && topics_.size() >= kMostMarkerTopics) {
    ++counters.ignored["markers of further topics"];
    return;
  }
  const std::size_t number = topics_.try_emplace(topic, topics_.size()).first->second;
  has_markers_ = true;
  std::optional<Refusal> refused;
  for (const visualization_msgs::Marker& marker : array_.markers) {
    const auto refusal = store_.Apply(number, marker, message.recorded_nanos);
    if (refusal && !refused) refused = refusal;
  }
  if (refused) ++counters.rejected[std::string("marker: ") + refused->kind];
}

void BagMarkers::AddTransforms(const tf2_msgs::TFMessage& message, bool is_static) {
  if (has_markers_ || is_static) tf_.Add(message, is_static);
}

void BagMarkers::Update(std::int64_t now_nanos, const std::string& world, const std::string& bag,
                        SampleSink& sink) {
  if (!has_markers_ || world.empty()) return;
  const auto find = [&](const std::string& frame,
                        std::int64_t stamp_nanos) -> std::optional<urdf::Pose> {
    if (frame.empty() || frame == world) return urdf::Pose{};
    return tf_.Find(world, frame, stamp_nanos);
  };
  if (store_.Update(now_nanos, find)) sink.OnRecordedMarkers(store_.markers());
  for (const MarkerStore::Lost& lost : store_.TakeLost()) {
    if (lost_frames_.size() >= kMostWarnings || !lost_frames_.insert(lost.text).second) continue;
    spdlog::warn("bag '{}': {}; it is not shown", bag, lost.text);
  }
}

}  // namespace kinescope::ros_bridge
