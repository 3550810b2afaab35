#include "render/camera/held_height.h"

#include <algorithm>
#include <cmath>

#include "core/person_outline.h"
#include "render/camera/camera.h"

namespace kinescope::render {
namespace {

constexpr double kMostFill = 0.85, kLeastFill = 0.60;  // of the height
constexpr double kHeightMemory = 10;                   // s
constexpr double kHeightInterval = 0.1;                // s, between heights that are remembered
constexpr double kHeightArrived = 0.005;               // m and m/s
// Of a glide: a critically damped spring. More room is needed sooner than less.
constexpr double kQuick = 4, kSlow = 1.5;  // 1/s

}  // namespace

double NeededHeight(const SceneState& state) {
  double needed = 0;
  for (const PersonState* person : FramedPeople(state)) {
    needed = std::max(needed, HeightFor(*person, state.floor_z));
  }
  return needed > 0 ? needed : kGroupFraming.height_m;
}

double HeldHeight::Follow(double needed, double secs) {
  const double dt = std::max(0.0, secs - at_secs_);
  if (seen_.empty() || secs < at_secs_) {
    seen_.clear();
    held_ = needed;
    speed_ = 0;
    is_gliding_ = false;
  }
  at_secs_ = secs;
  if (seen_.empty() || secs - seen_.back().secs >= kHeightInterval) seen_.push_back({secs, needed});
  while (secs - seen_.front().secs > kHeightMemory) seen_.pop_front();
  double goal = needed;
  for (const Seen& seen : seen_) goal = std::max(goal, seen.needed);
  const double fill = kLiveFill * goal / held_;
  is_gliding_ = is_gliding_ || fill > kMostFill || fill < kLeastFill;
  if (!is_gliding_) return held_;
  // The exact motion of the spring, so that the number of pictures does not matter.
  const double stiffness = goal > held_ ? kQuick : kSlow;
  const double decay = std::exp(-stiffness * dt);
  const double away = held_ - goal, pull = speed_ + stiffness * away;
  held_ = goal + decay * (away + dt * pull);
  speed_ = decay * (speed_ - stiffness * dt * pull);
  if (std::abs(held_ - goal) < kHeightArrived && std::abs(speed_) < kHeightArrived) {
    is_gliding_ = false;
    speed_ = 0;
  }
  return held_;
}

}  // namespace kinescope::render
