#include "server/picture/trails.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/system/check.h"

namespace kinescope::app {
namespace {

// No load class, not the centre of mass, and seen on light and dark floors.
constexpr std::array<Rgb, 4> kColors = {
    {{0.20, 0.45, 0.80}, {0.62, 0.44, 0.22}, {0.50, 0.53, 0.58}, {0.45, 0.72, 0.92}}};

// "right hand"
std::string NameOfTrack(int segment) {
  if (segment < 0) return "centre of mass";
  std::string name(urdf::kSegments[urdf::At(segment)].link_name);
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

}  // namespace

Trails::Trails(const TrailSettings& settings) : secs_(settings.secs) {
  KINESCOPE_CHECK(secs_ > 0 && secs_ <= kMaxSecs);
  for (const int segment : settings.tracks) {
    tracks_.push_back({segment, segment < 0 ? kComColor : kColors[tracks_.size() % kColors.size()],
                       NameOfTrack(segment)});
  }
}

void Trails::Remember(const SceneState& state) {
  if (tracks_.empty() || state.liveness != Liveness::kLive) return;
  newest_nanos_ = state.stamp_nanos;
  const auto oldest = newest_nanos_ - static_cast<std::int64_t>(std::llround(secs_ * 1e9));
  std::map<int, std::vector<std::deque<Point>>> kept;
  for (const PersonState& person : state.people) {
    auto& tracks = kept[person.character];
    tracks = std::move(past_[person.character]);
    tracks.resize(tracks_.size());
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      std::deque<Point>& points = tracks[i];
      while (!points.empty() && points.front().stamp_nanos < oldest) points.pop_front();
      const int segment = tracks_[i].segment;
      if (segment < 0 && !person.com) {
        points.clear();  // a gap is no straight line
        continue;
      }
      const Eigen::Vector3d& position =
          segment < 0 ? *person.com : person.links[urdf::At(segment)].position;
      // A scene between two that were remembered, or a recording that starts over.
      while (!points.empty() && points.back().stamp_nanos >= newest_nanos_) points.pop_back();
      points.push_back({newest_nanos_, position});
    }
  }
  past_ = std::move(kept);  // who has gone has no trail
}

std::vector<render::Trail> Trails::Make() const {
  std::vector<render::Trail> trails;
  for (const auto& [character, tracks] : past_) {
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      render::Trail trail;
      trail.color = tracks_[i].color;
      trail.name = tracks_[i].name;
      for (const Point& point : tracks[i]) trail.points.push_back(point.position);
      if (trail.points.size() > 1) trails.push_back(std::move(trail));
    }
  }
  return trails;
}

std::vector<render::Trail> Trails::WithoutPoints() const {
  std::vector<render::Trail> trails;
  for (const Track& track : tracks_) trails.push_back({{}, track.color, track.name});
  return trails;
}

}  // namespace kinescope::app
