#include "server/history/marker_log.h"

#include <algorithm>

namespace kinescope::history {
namespace {

std::size_t RoomOf(const SceneMarker& marker) {
  return sizeof marker + marker.points.size() * sizeof marker.points[0] +
         marker.colors.size() * sizeof marker.colors[0] + marker.ns.size() + marker.text.size() +
         marker.mesh_uri.size();
}

std::size_t RoomOf(const MarkerList& markers) {
  // A pointer, and its place in the table of uses.
  return markers.size() * (sizeof markers[0] + 4 * sizeof(void*));
}

}  // namespace

void MarkerLog::Add(const SceneState& state) {
  static const MarkerList kNone;
  const MarkerList& before = entries_.empty() ? kNone : entries_.back().markers;
  if (state.markers == before) return;
  entries_.push_back({state.number, state.markers});
  bytes_ += sizeof(Entry) + RoomOf(state.markers);
  for (const auto& marker : state.markers) {
    if (uses_[marker.get()]++ == 0) bytes_ += RoomOf(*marker);
  }
  while (bytes_ > most_bytes_ && entries_.size() > 1) DropOldest();
}

void MarkerLog::DropOldest() {
  const MarkerList& markers = entries_.front().markers;
  for (const auto& marker : markers) {
    const auto use = uses_.find(marker.get());
    if (--use->second > 0) continue;
    bytes_ -= RoomOf(*marker);
    uses_.erase(use);
  }
  bytes_ -= sizeof(Entry) + RoomOf(markers);
  entries_.pop_front();
}

const MarkerList& MarkerLog::Of(std::uint64_t number) const {
  static const MarkerList kNone;
  const auto after = std::upper_bound(
      entries_.begin(), entries_.end(), number,
      [](std::uint64_t value, const Entry& entry) { return value < entry.first_number; });
  return after == entries_.begin() ? kNone : std::prev(after)->markers;
}

void MarkerLog::ForgetBefore(std::uint64_t first_number) {
  while (entries_.size() > 1 && entries_[1].first_number <= first_number) DropOldest();
}

}  // namespace kinescope::history
