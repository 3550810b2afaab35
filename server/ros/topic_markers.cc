#include "server/ros/topic_markers.h"

#include <ros/message_traits.h>

#include <string_view>
#include <utility>

#include "server/ros/names.h"
#include "server/ros/raw_message.h"

namespace kinescope::ros_bridge {
namespace {

using visualization_msgs::InteractiveMarkerInit;
using visualization_msgs::InteractiveMarkerUpdate;

constexpr std::string_view kUpdate = "/update";

template <class Message>
bool Is(const std::string& md5sum) {
  return md5sum == ros::message_traits::md5sum<Message>();
}

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

bool EndsWithUpdate(const std::string& topic) {
  return topic.size() > kUpdate.size() &&
         topic.compare(topic.size() - kUpdate.size(), std::string::npos, kUpdate) == 0;
}

}  // namespace

bool TopicMarkers::IsShown(const std::string& md5sum) {
  return IsInteractive(md5sum) || FindShownMessage(md5sum) != nullptr;
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
    Taken<ShownMarkers> shown = FindShownMessage(md5sum)(bytes, style);
    if (!shown) return shown.error();
    if (!shelf_.Place(topic, style.earlier, *shown)) return std::nullopt;
    markers = *std::move(shown);
  }
  for (visualization_msgs::Marker& marker : markers) {
    marker.ns = WithoutSlashes(source);
    out.push_back(std::move(marker));
  }
  return refusal;
}

std::string TopicOfAll(const std::string& topic) {
  return EndsWithUpdate(topic) ? topic + "_full" : "";
}

std::string NamesOfShownTypes() {
  return NamesOfShownMessages() + ", visualization_msgs/InteractiveMarkerUpdate";
}

}  // namespace kinescope::ros_bridge
