#include "server/ros/interactive_markers.h"

#include <interactive_markers/tools.h>
#include <spdlog/fmt/fmt.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <mutex>
#include <utility>

#include "server/ros/shown_parts.h"

namespace kinescope::ros_bridge {
namespace {

using visualization_msgs::InteractiveMarker;
using visualization_msgs::InteractiveMarkerControl;
using visualization_msgs::InteractiveMarkerInit;
using visualization_msgs::InteractiveMarkerPose;
using visualization_msgs::InteractiveMarkerUpdate;
using visualization_msgs::Marker;

constexpr std::size_t kMostServers = 16;  // of one topic

Refusal TooMany(std::size_t most, const char* what) {
  return {"too many", fmt::format("the limit of {} {} of a topic is reached", most, what)};
}

// A message may have a name often; only the last one counts.
template <class Named>
std::map<std::string, const Named*> NewestByName(const std::vector<Named>& all) {
  std::map<std::string, const Named*> newest;
  for (const Named& each : all) newest[each.name] = &each;
  return newest;
}

// As many as autoComplete() makes at most.
std::size_t PartsOf(const InteractiveMarker& message) {
  constexpr std::size_t kDefaultParts = 2;  // arrows there and back
  std::size_t count = 1;                    // the title
  for (const InteractiveMarkerControl& control : message.controls) {
    count += std::max(control.markers.size(), kDefaultParts);
  }
  return count;
}

// Its rings and arrows where it says none, as RViz makes them.
void Complete(InteractiveMarker& message, bool is_translucent) {
  // It keeps a counter of all markers of the program.
  static std::mutex mutex;
  const std::lock_guard<std::mutex> lock(mutex);
  for (InteractiveMarkerControl& control : message.controls) control.name.clear();
  interactive_markers::autoComplete(message, is_translucent);
}

Eigen::Isometry3d PlaceOf(const geometry_msgs::Pose& pose) {
  return Eigen::Translation3d(PositionOf(pose)) * TurnOf(pose);
}

// Without a stamp it goes with its frame.
void SetHeader(Marker& marker, const std_msgs::Header& header) {
  marker.header = header;
  marker.frame_locked = header.stamp.isZero() ? 1U : 0U;
}

Marker ThinAxes(double length) {
  ShownStyle thin;
  thin.size_m = length;
  thin.width_m = 0.05 * length;
  return AxesMarker("", thin);
}

}  // namespace

InteractiveMarkers::Server* InteractiveMarkers::Find(const std::string& id) {
  if (servers_.count(id) == 0 && servers_.size() >= kMostServers) return nullptr;
  return &servers_[id];
}

int InteractiveMarkers::TakeId() {
  if (free_ids_.empty()) return next_id_++;
  return free_ids_.extract(free_ids_.begin()).value();
}

void InteractiveMarkers::Erase(Server& server, const std::string& name, ShownMarkers& out) {
  const auto found = server.markers.find(name);
  if (found == server.markers.end()) return;
  for (const Part& part : found->second.parts) {
    out.push_back(Without(part.marker.header, part.marker.id));
    free_ids_.insert(part.marker.id);
  }
  server.markers.erase(found);
}

void InteractiveMarkers::EraseAll(Server& server, ShownMarkers& out) {
  while (!server.markers.empty()) Erase(server, std::string(server.markers.begin()->first), out);
}

std::optional<Refusal> InteractiveMarkers::Put(Server& server, InteractiveMarker message,
                                               const ShownStyle& style, ShownMarkers& out) {
  Erase(server, message.name, out);
  if (message.controls.empty()) return std::nullopt;  // RViz calls it empty
  const std::size_t known = static_cast<std::size_t>(next_id_) - free_ids_.size();
  if (known + PartsOf(message) > kMostInteractiveMarkers) {
    return TooMany(kMostInteractiveMarkers, "markers");
  }
  Complete(message, style.alpha.value_or(0) < 1);
  Shown& shown = server.markers[message.name];
  shown.header = message.header;
  shown.first_pose = message.pose;
  const Eigen::Isometry3d place = PlaceOf(message.pose);
  const auto add = [&](Marker marker, bool is_fixed, bool has_axes_of_frame = false) {
    marker.ns.clear();
    marker.id = TakeId();
    marker.action = Marker::ADD;
    marker.lifetime = {};
    if (marker.header.frame_id.empty()) {  // its pose is that in the interactive marker
      const Eigen::Isometry3d local = PlaceOf(marker.pose);
      const Eigen::Isometry3d in_frame =
          has_axes_of_frame ? Eigen::Translation3d(place.translation()) * local : place * local;
      marker.pose = PoseAt(in_frame.translation(), Eigen::Quaterniond(in_frame.linear()));
      marker.header = message.header;
    }
    SetHeader(marker, std_msgs::Header(marker.header));
    out.push_back(marker);
    shown.parts.push_back({std::move(marker), is_fixed});
  };
  for (const InteractiveMarkerControl& control : message.controls) {
    if (control.always_visible == 0U && !style.has_handles) continue;
    // What faces the viewer in RViz keeps its orientation, unless it turns with the marker.
    const bool has_axes_of_frame = control.orientation_mode == InteractiveMarkerControl::FIXED;
    const bool is_fixed =
        has_axes_of_frame || (control.orientation_mode == InteractiveMarkerControl::VIEW_FACING &&
                              control.independent_marker_orientation == 0U);
    for (const Marker& marker : control.markers) add(marker, is_fixed, has_axes_of_frame);
  }
  if (!message.description.empty() && style.frames.has_names) {
    for (const Marker& title : interactive_markers::makeTitle(message).markers) add(title, false);
  }
  if (style.has_axes) add(ThinAxes(static_cast<double>(message.scale)), false);
  return std::nullopt;
}

void InteractiveMarkers::Move(Shown& shown, const InteractiveMarkerPose& to, ShownMarkers& out) {
  const Eigen::Isometry3d from = PlaceOf(shown.first_pose), now = PlaceOf(to.pose);
  const Eigen::Isometry3d motion = now * from.inverse();
  for (const Part& part : shown.parts) {
    // One with a frame of its own stays in it.
    if (part.marker.header.frame_id != shown.header.frame_id) continue;
    Eigen::Isometry3d place = PlaceOf(part.marker.pose);
    if (part.is_fixed) {
      place.pretranslate(now.translation() - from.translation());
    } else {
      place = motion * place;
    }
    Marker marker = part.marker;
    marker.pose = PoseAt(place.translation(), Eigen::Quaterniond(place.linear()));
    SetHeader(marker, to.header);
    out.push_back(std::move(marker));
  }
}

std::optional<Refusal> InteractiveMarkers::PutAll(Server& server,
                                                  const std::vector<InteractiveMarker>& markers,
                                                  const std::set<std::string>& without,
                                                  const ShownStyle& style, ShownMarkers& out) {
  std::optional<Refusal> first;
  for (const auto& [name, marker] : NewestByName(markers)) {
    if (without.count(name) != 0) continue;
    auto refusal = Put(server, *marker, style, out);
    if (refusal && !first) first = std::move(refusal);
  }
  return first;
}

std::optional<Refusal> InteractiveMarkers::Take(const InteractiveMarkerInit& message,
                                                const ShownStyle& style, ShownMarkers& out) {
  Server* const server = Find(message.server_id);
  if (server == nullptr) return TooMany(kMostServers, "servers");
  // Messages of a topic come in order: a smaller number is that of a server that was restarted.
  if (server->init && message.seq_num < *server->init) {
    server->init.reset();
    server->update.reset();
    server->changed.clear();
    server->moves.clear();
  }
  const bool is_first = !server->init;
  const bool has_update = server->update && message.seq_num <= *server->update;
  server->init = message.seq_num;
  if (has_update && !is_first) return std::nullopt;  // nothing in it is new
  const std::set<std::string> changed = std::exchange(server->changed, {});
  const auto moves = std::exchange(server->moves, {});
  if (!has_update) EraseAll(*server, out);
  auto refusal =
      PutAll(*server, message.markers, has_update ? changed : std::set<std::string>(), style, out);
  if (!has_update) return refusal;
  for (const auto& [name, pose] : moves) {
    const auto marker = server->markers.find(name);
    if (marker != server->markers.end() && changed.count(name) == 0)
      Move(marker->second, pose, out);
  }
  return refusal;
}

std::optional<Refusal> InteractiveMarkers::Take(const InteractiveMarkerUpdate& message,
                                                const ShownStyle& style, ShownMarkers& out) {
  Server* const server = Find(message.server_id);
  if (server == nullptr) return TooMany(kMostServers, "servers");
  if (server->update && message.seq_num < *server->update) {  // restarted
    EraseAll(*server, out);
    *server = Server();
  }
  server->update = message.seq_num;
  if (message.type != InteractiveMarkerUpdate::UPDATE) return std::nullopt;
  if (server->init && message.seq_num <= *server->init) return std::nullopt;  // the whole has it
  const auto note = [&](const std::string& name) {
    const bool is_wanted = !server->init && server->changed.size() < kMostInteractiveMarkers;
    if (is_wanted) server->changed.insert(name);
  };
  for (const std::string& name : message.erases) {
    note(name);
    Erase(*server, name, out);
  }
  for (const InteractiveMarker& marker : message.markers) note(marker.name);
  auto refusal = PutAll(*server, message.markers, {}, style, out);
  for (const auto& [name, pose] : NewestByName(message.poses)) {
    const auto marker = server->markers.find(name);
    if (marker != server->markers.end()) {
      Move(marker->second, *pose, out);
    } else if (!server->init && server->moves.size() < kMostInteractiveMarkers) {
      server->moves[name] = *pose;
    }
  }
  return refusal;
}

}  // namespace kinescope::ros_bridge
