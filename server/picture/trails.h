/// Where chosen points have been: collected scene by scene, in order, so that any renderer can draw
/// any picture of a clip. One thread.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "core/scene_state.h"
#include "render/scene_look.h"

namespace kinescope::app {

struct TrailSettings {
  std::vector<int> tracks = {};  // urdf::Segment, or -1 for the centre of mass
  double secs = 2;
};

class Trails {
 public:
  static constexpr double kMaxSecs = 60;

  /// @pre 0 < settings.secs <= kMaxSecs
  explicit Trails(const TrailSettings& settings);

  bool empty() const { return tracks_.empty(); }
  double secs() const { return secs_; }

  /// The next scene. One from before the last starts over.
  void Remember(const SceneState& state);

  /// As of the last scene, of every person who was in it.
  std::vector<render::Trail> Make() const;

  /// Names and colours alone, of all tracks.
  std::vector<render::Trail> WithoutPoints() const;

 private:
  struct Track {
    int segment = -1;  // urdf::Segment; -1: the centre of mass
    Rgb color;
    std::string name;
  };
  struct Point {
    std::int64_t stamp_nanos;
    Eigen::Vector3d position;
  };
  std::vector<Track> tracks_;
  double secs_;
  std::int64_t newest_nanos_ = 0;
  std::map<int, std::vector<std::deque<Point>>> past_;  // by character; by track, oldest first
};

}  // namespace kinescope::app
