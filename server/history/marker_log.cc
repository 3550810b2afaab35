#include "server/history/marker_log.h"

#include <algorithm>

namespace kinescope::history {
namespace {

constexpr std::size_t kLargeBytes = 32 << 10;
constexpr char kForgotten[] = "it is large, and no longer kept";

std::size_t RoomOf(const SceneMarker& marker) {
  return sizeof marker + marker.points.size() * sizeof marker.points[0] +
         marker.colors.size() * sizeof marker.colors[0] + marker.ns.size() + marker.text.size() +
         marker.mesh_uri.size();
}

// Null: it is not among them.
std::shared_ptr<const SceneMarker>* Find(const std::shared_ptr<const SceneMarker>& marker,
                                         MarkerList& markers) {
  const auto found = std::find(markers.begin(), markers.end(), marker);
  return found == markers.end() ? nullptr : &*found;
}

std::size_t RoomOf(const MarkerList& markers) {
  // A pointer, and its place in the table of uses.
  return markers.size() * (sizeof markers[0] + 4 * sizeof(void*));
}

}  // namespace

void MarkerLog::Use(const std::shared_ptr<const SceneMarker>& marker) {
  if (uses_[marker.get()]++ == 0) bytes_ += RoomOf(*marker);
}

void MarkerLog::Release(const std::shared_ptr<const SceneMarker>& marker) {
  const auto use = uses_.find(marker.get());
  if (--use->second > 0) return;
  bytes_ -= RoomOf(*marker);
  uses_.erase(use);
}

void MarkerLog::Add(const SceneState& state) {
  static const MarkerList kNone;
  const MarkerList& before = entries_.empty() ? kNone : entries_.back().markers;
  if (state.markers == before) return;
  entries_.push_back({state.number, state.markers});
  bytes_ += sizeof(Entry) + RoomOf(state.markers);
  for (const auto& marker : state.markers) Use(marker);
  while (bytes_ > most_bytes_ && entries_.size() > 1) {
    if (bare_ + 1 < entries_.size()) {
      ForgetLarge(bare_++);
    } else {
      DropOldest();
    }
  }
}

// Those that the next list has, too, would take as much room as before. The others are forgotten in
// all lists.
void MarkerLog::ForgetLarge(std::size_t entry) {
  const MarkerList markers = entries_[entry].markers;
  for (const auto& large : markers) {
    if (RoomOf(*large) < kLargeBytes || Find(large, entries_[entry + 1].markers)) continue;
    auto bare = std::make_shared<SceneMarker>();
    bare->ns = large->ns;
    bare->id = large->id;
    bare->text = kForgotten;
    for (std::size_t i = entry + 1; i-- > 0;) {
      std::shared_ptr<const SceneMarker>* const place = Find(large, entries_[i].markers);
      if (place == nullptr) break;
      *place = bare;
      Use(bare);
      Release(large);
    }
  }
}

void MarkerLog::DropOldest() {
  const MarkerList& markers = entries_.front().markers;
  for (const auto& marker : markers) Release(marker);
  bytes_ -= sizeof(Entry) + RoomOf(markers);
  entries_.pop_front();
  if (bare_ > 0) --bare_;
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
