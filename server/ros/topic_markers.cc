#include "server/ros/topic_markers.h"

#include <sensor_msgs/JointState.h>

#include <memory>
#include <string_view>
#include <utility>

#include "server/ros/calibration.h"
#include "server/ros/image_messages.h"
#include "server/ros/names.h"
#include "server/ros/raw_message.h"

namespace kinescope::ros_bridge {
namespace {

using map_msgs::OccupancyGridUpdate;
using nav_msgs::OccupancyGrid;
using sensor_msgs::JointState;
using visualization_msgs::InteractiveMarkerInit;
using visualization_msgs::InteractiveMarkerUpdate;

constexpr std::string_view kUpdate = "/update";

bool IsInteractive(const std::string& md5sum) {
  return Is<InteractiveMarkerInit>(md5sum) || Is<InteractiveMarkerUpdate>(md5sum);
}

template <class Message>
std::optional<Refusal> TakeInteractive(InteractiveMarkers& markers, const ShownStyle& style,
                                       const std::vector<std::uint8_t>& bytes, ShownMarkers& out) {
  Message message;
  if (!ReadBounded(bytes.data(), bytes.size(), message)) return Unreadable();
  return markers.Take(message, style, out);
}

bool IsOfDepths(const std::string& md5sum, const ShownStyle& style) {
  return style.camera.is_cloud && (IsImageType(md5sum) || IsCalibrationType(md5sum));
}

bool IsOfUpdatedMap(const std::string& md5sum, const ShownStyle& style) {
  return style.has_updates && (Is<OccupancyGrid>(md5sum) || Is<OccupancyGridUpdate>(md5sum));
}

// An image that does not outlive `bytes`.
Taken<CameraImage> ReadImageIn(const std::string& md5sum, const std::vector<std::uint8_t>& bytes) {
  return ReadImage(md5sum, {std::shared_ptr<const void>(), &bytes});
}

bool EndsWithUpdate(const std::string& topic) {
  return topic.size() > kUpdate.size() &&
         topic.compare(topic.size() - kUpdate.size(), std::string::npos, kUpdate) == 0;
}

}  // namespace

bool TopicMarkers::IsShown(const std::string& md5sum, const ShownStyle& style) {
  return IsInteractive(md5sum) || IsOfDepths(md5sum, style) || IsOfUpdatedMap(md5sum, style) ||
         Is<JointState>(md5sum) || FindShownMessage(md5sum) != nullptr;
}

MarkerLook TopicMarkers::LookOf(const std::string& md5sum, const ShownStyle& style) {
  MarkerLook look;
  look.is_converted = !IsInteractive(md5sum);
  if (Is<OccupancyGrid>(md5sum) || Is<OccupancyGridUpdate>(md5sum)) {
    look.ground = style.is_behind ? GroundLayer::kFirstMap : GroundLayer::kMap;
  } else if (Is<nav_msgs::GridCells>(md5sum)) {
    look.ground = GroundLayer::kCells;
  }
  const bool has_lines = Is<nav_msgs::Path>(md5sum) || Is<geometry_msgs::PolygonStamped>(md5sum) ||
                         (Is<geometry_msgs::PoseArray>(md5sum) && !style.has_axes);
  look.has_thin_lines = has_lines && style.size_px.has_value();
  return look;
}

std::optional<Refusal> TopicMarkers::Take(std::size_t topic, const std::string& name,
                                          const ShownStyle& style, const std::string& md5sum,
                                          const std::vector<std::uint8_t>& bytes,
                                          ShownMarkers& out) {
  ShownMarkers markers;
  std::string source = name;
  std::optional<Refusal> refusal;
  if (IsInteractive(md5sum)) {
    InteractiveMarkers& servers = interactive_[topic];
    refusal = Is<InteractiveMarkerInit>(md5sum)
                  ? TakeInteractive<InteractiveMarkerInit>(servers, style, bytes, markers)
                  : TakeInteractive<InteractiveMarkerUpdate>(servers, style, bytes, markers);
    if (EndsWithUpdate(name)) source.resize(name.size() - kUpdate.size());
  } else {
    Taken<ShownMarkers> shown = ToMarkersOf(topic, style, md5sum, bytes);
    if (!shown) return shown.error();
    if (shown->empty()) return std::nullopt;
    // Rings go with their joints, so of earlier messages nothing is left.
    const bool stays = !Is<JointState>(md5sum);
    if (stays && !shelf_.Place(topic, style.earlier, *shown)) return std::nullopt;
    markers = *std::move(shown);
  }
  for (ShownMarker& marker : markers) {
    marker.ns = WithoutSlashes(source);
    out.push_back(std::move(marker));
  }
  return refusal;
}

std::optional<Refusal> TopicMarkers::TakeColors(std::size_t topic, const std::string& md5sum,
                                                const std::vector<std::uint8_t>& bytes) {
  if (!IsImageType(md5sum)) return Refusal{"another type", "colours of depths: no image"};
  Taken<CameraImage> image =
      ReadImage(md5sum, std::make_shared<const std::vector<std::uint8_t>>(bytes));
  if (!image) return image.error();
  return clouds_.PutColors(topic, *std::move(image));
}

Taken<ShownMarkers> TopicMarkers::ToMarkersOf(std::size_t topic, const ShownStyle& style,
                                              const std::string& md5sum,
                                              const std::vector<std::uint8_t>& bytes) {
  if (IsOfDepths(md5sum, style)) return TakeDepths(topic, style, md5sum, bytes);
  if (IsOfUpdatedMap(md5sum, style)) return TakeMap(topic, style, md5sum, bytes);
  if (!Is<JointState>(md5sum)) return FindShownMessage(md5sum)(bytes, style);
  JointState joints;
  if (!ReadBounded(bytes.data(), bytes.size(), joints)) return tl::unexpected(Unreadable());
  return ToMarkers(joints, find_joint_, style);
}

Taken<ShownMarkers> TopicMarkers::TakeDepths(std::size_t topic, const ShownStyle& style,
                                             const std::string& md5sum,
                                             const std::vector<std::uint8_t>& bytes) {
  if (IsCalibrationType(md5sum)) {
    const Taken<Calibration> calibration = ReadCalibration(bytes);
    if (!calibration) return tl::unexpected(calibration.error());
    clouds_.PutCalibration(topic, *calibration);
    return ShownMarkers{};
  }
  const Taken<CameraImage> depths = ReadImageIn(md5sum, bytes);
  if (!depths) return tl::unexpected(depths.error());
  std_msgs::Header header;
  if (!ReadBounded(bytes.data(), bytes.size(), header)) return tl::unexpected(Unreadable());
  return clouds_.ToMarkers(topic, *depths, header, style);
}

Taken<ShownMarkers> TopicMarkers::TakeMap(std::size_t topic, const ShownStyle& style,
                                          const std::string& md5sum,
                                          const std::vector<std::uint8_t>& bytes) {
  if (Is<OccupancyGridUpdate>(md5sum)) {
    OccupancyGridUpdate update;
    if (!ReadBounded(bytes.data(), bytes.size(), update)) return tl::unexpected(Unreadable());
    return maps_.Update(topic, update, style);
  }
  OccupancyGrid map;
  if (!ReadBounded(bytes.data(), bytes.size(), map)) return tl::unexpected(Unreadable());
  return maps_.Put(topic, std::move(map), style);
}

std::vector<HeardTopic> TopicsHeardFor(const ShownTopic& shown) {
  std::vector<HeardTopic> all = {{shown.name}};
  if (EndsWithUpdate(shown.name)) all.push_back({shown.name + "_full"});
  const CameraStyle& camera = shown.style.camera;
  if (camera.is_cloud || camera.scene_opacity > 0) {
    all.push_back({CalibrationTopicOf(shown.name)});
  }
  if (!camera.color_topic.empty()) all.push_back({camera.color_topic, true});
  if (shown.style.has_array) all.push_back({shown.name + "_array"});
  if (shown.style.has_updates) all.push_back({shown.name + "_updates"});
  return all;
}

std::string NamesOfShownTypes() {
  return NamesOfShownMessages() +
         ", sensor_msgs/JointState, visualization_msgs/InteractiveMarkerUpdate";
}

}  // namespace kinescope::ros_bridge
