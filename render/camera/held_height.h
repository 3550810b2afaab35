/// How much height a live picture shows: as little as people need, but it seldom changes. One
/// thread.
#pragma once

#include <deque>

#include "core/scene_state.h"

namespace kinescope::render {

/// Height that a picture must show so that the people fill most of it: the highest part of them
/// above the floor, or twice how far they reach to a side, m. Without people: that of a standing
/// adult with arms overhead.
double NeededHeight(const SceneState& state);

/// Shows what was needed during the last seconds. It goes over to more as soon as people would fill
/// more than 85 % of the height, and to less only where they have filled less than 60 % for some
/// time: who lifts boxes is not zoomed in and out.
class HeldHeight {
 public:
  /// Call it once per picture. @param secs of the picture; if it goes back, what was before is
  /// forgotten. @return m
  double Follow(double needed, double secs);

 private:
  struct Seen {
    double secs, needed;
  };
  std::deque<Seen> seen_;  // the oldest first
  double held_ = 0, speed_ = 0, at_secs_ = 0;
  bool is_gliding_ = false;
};

}  // namespace kinescope::render
