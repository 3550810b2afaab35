/// How much a live picture shows: as little as people need, but it seldom changes. One thread.
#pragma once

#include <deque>

#include "core/person_outline.h"
#include "core/scene_state.h"

namespace kinescope::render {

/// What a picture must show so that the people fill most of it (RoomFor). Without people: the
/// height of a standing adult with arms overhead.
ViewRoom NeededRoom(const SceneState& state);

/// Shows what was needed during the last two seconds. It goes over to more as soon as people would
/// fill more than 85 % of the height or be cut off, and slowly to less where they have filled less
/// than 65 %. If that was too soon, because they rise again, it waits twice as long the next time:
/// who lifts boxes is not zoomed in and out.
class HeldRoom {
 public:
  /// Call it once per picture. @param secs of the picture; if it goes back, what was before is
  /// forgotten
  ViewRoom Follow(const ViewRoom& needed, double secs);

 private:
  struct Seen {
    double secs;
    ViewRoom needed;
  };

  ViewRoom Recent(const ViewRoom& needed, double secs);
  void LearnToWait(const ViewRoom& goal, bool is_too_much, double secs);
  void GlideTo(const ViewRoom& goal, double dt);

  std::deque<Seen> seen_;  // the oldest first
  ViewRoom held_, speed_;  // speed_: m/s
  double at_secs_ = 0;
  double wait_ = 0;              // s, for which what was needed is shown
  double came_nearer_at_ = 0;    // s
  double came_nearer_from_ = 0;  // m
  bool may_regret_ = false;      // it came nearer, and has not gone back
  bool is_gliding_ = false;
};

}  // namespace kinescope::render
