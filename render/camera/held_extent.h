/// What a live camera is aimed at: it stands still while the people stay in its picture, and glides
/// when one of them leaves it. One thread.
#pragma once

#include <deque>

#include "core/scene_state.h"
#include "render/camera/camera.h"

namespace kinescope::render {

/// What a picture of people shows when it is aimed at their middle.
struct ShownRoom {
  double height = kGroupFraming.height_m;  // m
  double reach = kGroupFraming.margin_m;   // m, of a person to each side, with a margin
};

/// Aims at the ground on which people were during the last seconds, if it fits into about one
/// picture (walking to and fro, in circles, on a treadmill that is not quite even): then nothing
/// moves but the people. A person who walks on is followed. A camera that stands still is more
/// pleasant to watch, and its floor is drawn once.
class HeldGroundExtent {
 public:
  /// Call it once per picture.
  /// @param secs    of the picture; if it goes back, what was before is forgotten
  /// @param aspect  width / height of the picture
  const GroundExtent& Follow(const SceneState& state, double secs, double aspect,
                             const ShownRoom& room = {});

  /// What the picture is to show now, m: more than `room` if people were elsewhere a moment ago.
  double height() const { return height_; }

 private:
  struct Seen {
    double secs;
    GroundExtent people;
  };

  void Remember(const GroundExtent& people, double secs);
  /// Around all that is remembered.
  GroundExtent Recent() const;
  Eigen::Vector3d Velocity() const;
  void GlideTo(const GroundExtent& goal, double dt);

  std::deque<Seen> seen_;  // the oldest first
  bool has_people_ = false, is_gliding_ = false;
  double at_secs_ = 0;
  double height_ = kGroupFraming.height_m;
  GroundExtent held_, speed_;  // speed_: m/s
};

}  // namespace kinescope::render
