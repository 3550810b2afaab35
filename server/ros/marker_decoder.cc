#include "server/ros/marker_decoder.h"

#include <nav_msgs/OccupancyGrid.h>
#include <spdlog/fmt/fmt.h>

#include <memory>

#include "server/ros/image_box.h"
#include "server/ros/image_messages.h"
#include "server/ros/markers.h"

namespace kinescope::ros_bridge {
namespace {

constexpr std::size_t kLongestMarkerType = 80;  // bytes, in the name of a counter: it is untrusted

bool IsSingle(const std::string& md5sum) { return Is<visualization_msgs::Marker>(md5sum); }
bool IsArray(const std::string& md5sum) { return Is<visualization_msgs::MarkerArray>(md5sum); }

// Whether the newest message of the topic is all that is shown of it. Updates of a map belong to
// the map before them.
bool ReplacesThoseBefore(const std::string& md5sum, const ShownStyle& style, bool has_colors) {
  if (has_colors || IsImageType(md5sum)) return true;
  if (style.has_updates && Is<nav_msgs::OccupancyGrid>(md5sum)) return false;
  const bool stays = style.earlier.keep > 1 || style.earlier.decay_secs > 0;
  return !stays && FindShownMessage(md5sum) != nullptr;
}

}  // namespace

void MarkerDecoder::OnMessage(std::size_t topic, const Event& event, bool has_colors,
                              std::int64_t monotonic_nanos) {
  const std::string type = Said(event, "md5sum");
  if (ReplacesThoseBefore(type, topics_[topic].style, has_colors)) {
    const auto [kept, is_new] = kept_.try_emplace({topic, has_colors});
    if (!is_new) {
      decoded_.push_back({topic, monotonic_nanos});
      decoded_.back().refusal =
          Refusal{"too fast", "messages come faster than they are shown: only the newest are"};
    }
    kept->second = {event, monotonic_nanos};
    return;
  }
  Add(topic, {event, monotonic_nanos}, has_colors, monotonic_nanos);
}

void MarkerDecoder::DecodeKept(std::int64_t monotonic_nanos) {
  for (const auto& [place, kept] : std::exchange(kept_, {})) {
    Add(place.first, kept, place.second, monotonic_nanos);
  }
  for (auto& [topic, early] : early_) {
    if (!early.newest) continue;
    const Kept message = *std::exchange(early.newest, std::nullopt);
    Add(topic, message, false, monotonic_nanos);
  }
}

void MarkerDecoder::Add(std::size_t topic, const Kept& message, bool has_colors,
                        std::int64_t now_nanos) {
  DecodedMessage decoded{topic, message.monotonic_nanos};
  Decode(topic, message.event, has_colors, decoded);
  if (IsEarly(topic, message, decoded, now_nanos)) return;
  // Calibrations and colours that a cloud keeps to itself are nothing to show.
  const bool is_kept =
      has_colors || (IsCalibrationType(Said(message.event, "md5sum")) && !decoded.calibration);
  if (is_kept && !decoded.refusal) return;
  if (const auto early = early_.find(topic); early != early_.end() && !is_kept) {
    early->second.newest.reset();  // it is older
  }
  decoded_.push_back(std::move(decoded));
}

bool MarkerDecoder::IsEarly(std::size_t topic, const Kept& message, const DecodedMessage& decoded,
                            std::int64_t now_nanos) {
  constexpr std::int64_t kLongestWait = 1'000'000'000;
  if (!decoded.refusal || !decoded.refusal->may_come) return false;
  Early& early = early_.try_emplace(topic, Early{message.monotonic_nanos}).first->second;
  if (now_nanos - early.since_nanos >= kLongestWait) return false;
  early.newest = message;
  return true;
}

void MarkerDecoder::DecodeMarkers(const RawMessage& raw, bool is_array, DecodedMessage& to) {
  if (!(is_array ? ros_bridge::Decode(raw.bytes, array_)
                 : ros_bridge::Decode(raw.bytes, marker_))) {
    to.refusal = Unreadable();
    return;
  }
  to.has_single_markers = true;
  if (is_array) {
    to.markers.assign(array_.markers.begin(), array_.markers.end());
  } else {
    to.markers = {marker_};
  }
}

void MarkerDecoder::Decode(std::size_t topic, const Event& event, bool has_colors,
                           DecodedMessage& to) {
  const RawMessage& raw = *event.getConstMessage();
  const std::string type = Said(event, "md5sum");
  const ShownTopic& shown = topics_[topic];
  if (raw.bytes.empty()) {  // of a larger one roscpp delivers nothing
    to.refusal = {
        "empty, or too large",
        fmt::format("a message that is empty, or larger than {} MiB", kLargestMessage >> 20U),
        /*is_in_log=*/false};  // tcpros_limits.h
  } else if (has_colors) {
    to.refusal = shown_.TakeColors(topic, type, raw.bytes);
  } else if (IsSingle(type) || IsArray(type)) {
    DecodeMarkers(raw, IsArray(type), to);
  } else if (TopicMarkers::IsShown(type, shown.style)) {
    to.look = TopicMarkers::LookOf(type, shown.style);
    to.refusal = shown_.Take(topic, shown.name, shown.style, type, raw.bytes, to.markers);
  } else if (IsCalibrationType(type)) {
    Taken<Calibration> calibration = ReadCalibration(raw.bytes);
    if (calibration) {
      to.calibration = *std::move(calibration);
    } else {
      to.refusal = calibration.error();
    }
  } else if (IsImageType(type)) {
    const auto& message = event.getConstMessage();  // which lives as long as its pixels are shown
    const std::shared_ptr<const std::vector<std::uint8_t>> bytes(&message->bytes,
                                                                 [message](const void*) {});
    Taken<CameraImage> image = ReadImage(type, bytes);
    if (image) {
      to.image = *std::move(image);
      to.image->name = NameOfCamera(shown.name);
      to.image->received_nanos = to.monotonic_nanos;
    } else {
      to.refusal = image.error();
    }
  } else {
    to.refusal = {
        "another type",
        fmt::format("message type {}: expected visualization_msgs/Marker, "
                    "visualization_msgs/MarkerArray, sensor_msgs/Image, CompressedImage, "
                    "{}",
                    Said(event, "type").substr(0, kLongestMarkerType), NamesOfShownTypes())};
  }
}

}  // namespace kinescope::ros_bridge
