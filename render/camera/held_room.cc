#include "render/camera/held_room.h"

#include <algorithm>
#include <cmath>

#include "render/camera/camera.h"
#include "render/camera/spring.h"

namespace kinescope::render {
namespace {

constexpr double kMostFill = 0.85, kLeastFill = 0.65;  // of the height
constexpr double kSpareBelow = 0.03;                   // of the height, that people may use up
constexpr double kShortWait = 2, kLongWait = 10;       // s
constexpr double kRegret = 10;          // s after coming nearer, in which going back was a mistake
constexpr double kBack = 0.9;           // of the height from which it came nearer
constexpr double kRoomInterval = 0.1;   // s, between rooms that are remembered
constexpr double kRoomArrived = 0.005;  // m and m/s
// Of a glide. More room is needed sooner than less.
constexpr double kQuick = 4, kSlow = 1.5;  // 1/s

ViewRoom Union(const ViewRoom& a, const ViewRoom& b) {
  return {std::max(a.height, b.height), std::max(a.below, b.below)};
}

}  // namespace

ViewRoom NeededRoom(const SceneState& state) {
  ViewRoom needed;
  for (const PersonState* person : FramedPeople(state)) {
    needed = Union(needed, RoomFor(*person, state.floor_z));
  }
  return needed.height > 0 ? needed : ViewRoom{kGroupFraming.height_m, 0};
}

// Of what was needed since `wait_`, and now.
ViewRoom HeldRoom::Recent(const ViewRoom& needed, double secs) {
  if (seen_.empty() || secs - seen_.back().secs >= kRoomInterval) seen_.push_back({secs, needed});
  while (secs - seen_.front().secs > kLongWait) seen_.pop_front();
  ViewRoom recent = needed;
  for (const Seen& seen : seen_) {
    if (secs - seen.secs <= wait_) recent = Union(recent, seen.needed);
  }
  return recent;
}

void HeldRoom::LearnToWait(const ViewRoom& goal, bool is_too_much, double secs) {
  if (is_too_much) {
    if (!may_regret_) came_nearer_from_ = held_.height;
    may_regret_ = true;
    came_nearer_at_ = secs;
  }
  if (!may_regret_) return;
  const bool is_soon = secs - came_nearer_at_ < kRegret;
  const bool goes_back = goal.height > kBack * came_nearer_from_;
  if (is_soon && !goes_back) return;
  may_regret_ = false;
  wait_ = is_soon ? std::min(2 * wait_, kLongWait) : kShortWait;
}

void HeldRoom::GlideTo(const ViewRoom& goal, double dt) {
  const double stiffness = goal.height < held_.height ? kSlow : kQuick;
  const auto glide = [&](double& value, double& speed, double to) {
    Glide(value, speed, to, stiffness, dt);
    return std::abs(value - to) < kRoomArrived && std::abs(speed) < kRoomArrived;
  };
  const bool is_high = glide(held_.height, speed_.height, goal.height);
  const bool is_low = glide(held_.below, speed_.below, goal.below);
  if (!is_high || !is_low) return;
  is_gliding_ = false;
  speed_ = {};
}

ViewRoom HeldRoom::Follow(const ViewRoom& needed, double secs) {
  const double dt = std::max(0.0, secs - at_secs_);
  if (seen_.empty() || secs < at_secs_) {
    *this = {};
    held_ = needed;
    wait_ = kShortWait;
  }
  at_secs_ = secs;
  const ViewRoom goal = Recent(needed, secs);
  const double fill = kLiveFill * goal.height / held_.height;
  const bool is_too_little =
      fill > kMostFill || goal.below > held_.below + kSpareBelow * held_.height;
  const bool is_too_much = fill < kLeastFill;
  LearnToWait(goal, is_too_much, secs);
  is_gliding_ = is_gliding_ || is_too_little || is_too_much;
  if (is_gliding_) GlideTo(goal, dt);
  return held_;
}

}  // namespace kinescope::render
