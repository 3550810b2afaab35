#include "server/scene/held_heading.h"

#include <algorithm>
#include <cmath>

#include "core/system/clocks.h"
#include "urdf/heading.h"

namespace kinescope::app {
namespace {

constexpr double kRadPerDegree = M_PI / 180;

// People neither run nor spin faster; above it, they were put elsewhere.
constexpr double kJump = 0.3, kFastestMove = 12;                                       // m, m/s
constexpr double kJumpTurn = 20 * kRadPerDegree, kFastestTurn = 1200 * kRadPerDegree;  // rad, rad/s
constexpr double kLongestStep = 1;   // s, for which that holds
constexpr double kForgetAfter = 10;  // s without a sample

constexpr double kUpright = 0.7;  // of the chest's z axis, along the world's

// A critically damped spring, which neither jerks nor overshoots; half of the way takes 1.1 s.
constexpr double kHeadingStiffness = 1.5;  // 1/s
constexpr double kStartsAt = 15 * kRadPerDegree, kEndsAt = 2 * kRadPerDegree;
constexpr double kEndSpeed = 3 * kRadPerDegree;  // per second

constexpr double kMeanSecs = 0.7;
// Length of the mean direction below which the person spins, faster than one turn in 6 s. A camera
// that follows is then less than half a turn behind.
constexpr double kSpins = 0.8;

double Between(double from, double to) { return std::remainder(to - from, 2 * M_PI); }

}  // namespace

double AlongFloorLines(double heading_rad) {
  constexpr double kRight = M_PI / 2, kNearly = 8 * kRadPerDegree;
  const double along = kRight * std::round(heading_rad / kRight);
  return std::abs(heading_rad - along) < kNearly ? along : heading_rad;
}

bool HeldHeading::IsContinued(const PersonState& person, double dt) const {
  if (dt < 0 || dt > kForgetAfter) return false;
  if (person.character != *character_) return true;  // another one has become the first
  if (person.sample.counter < counter_) return false;
  const double step = std::min(dt, kLongestStep);
  const urdf::Pose& pelvis = person.links[urdf::kPelvis];
  return (pelvis.position - pelvis_.position).norm() <= kJump + kFastestMove * step &&
         pelvis.orientation.angularDistance(pelvis_.orientation) <= kJumpTurn + kFastestTurn * step;
}

double HeldHeading::Follow(const PersonState& person) {
  if (frame_ == CameraFrame::kWorld) return 0;
  const std::optional<double> now = urdf::HeadingOf(person.links).rad;
  const double dt = character_ ? Secs(person.sample.stamp_nanos - stamp_nanos_) : 0;
  if (!character_ || !IsContinued(person, dt)) {
    Begin(now);
  }
  if (frame_ == CameraFrame::kStart) {
    FollowStart(person.links, now);
  } else {
    FollowPerson(now, std::max(0.0, dt));
  }
  if (is_gliding_ && dt > 0) Glide(dt);
  character_ = person.character;
  stamp_nanos_ = person.sample.stamp_nanos;
  counter_ = person.sample.counter;
  pelvis_ = person.links[urdf::kPelvis];
  return shown_;
}

// At once, without a glide: what was shown before has nothing to do with it.
void HeldHeading::Begin(std::optional<double> now) {
  has_stood_ = is_gliding_ = false;
  speed_ = 0;
  mean_.setZero();
  if (now) shown_ = goal_ = frame_ == CameraFrame::kStart ? AlongFloorLines(*now) : *now;
}

void HeldHeading::FollowStart(const urdf::LinkPoses& links, std::optional<double> now) {
  const bool is_upright = (links[urdf::kT8].orientation * Eigen::Vector3d::UnitZ()).z() > kUpright;
  if (has_stood_ || !now || !is_upright) return;
  has_stood_ = true;
  goal_ = AlongFloorLines(*now);
  is_gliding_ = goal_ != shown_;
}

void HeldHeading::FollowPerson(std::optional<double> now, double dt) {
  if (now) {
    const Eigen::Vector2d direction(std::cos(*now), std::sin(*now));
    const double share = mean_.isZero() ? 1 : 1 - std::exp(-dt / kMeanSecs);
    mean_ += share * (direction - mean_);
  }
  if (mean_.norm() < kSpins) {
    goal_ = shown_;  // slows down
    return;
  }
  goal_ = std::atan2(mean_.y(), mean_.x());
  is_gliding_ = is_gliding_ || std::abs(Between(shown_, goal_)) > kStartsAt;
}

// The exact motion of the spring, so that the rate of the samples does not matter.
void HeldHeading::Glide(double dt) {
  const double decay = std::exp(-kHeadingStiffness * dt);
  const double away = Between(goal_, shown_), pull = speed_ + kHeadingStiffness * away;
  const double left = decay * (away + dt * pull);
  shown_ = std::remainder(goal_ + left, 2 * M_PI);
  speed_ = decay * (speed_ - kHeadingStiffness * dt * pull);
  const bool is_held = frame_ == CameraFrame::kStart;
  if (std::abs(left) > (is_held ? 1e-4 : kEndsAt) ||
      std::abs(speed_) > (is_held ? 1e-3 : kEndSpeed)) {
    return;
  }
  is_gliding_ = false;
  speed_ = 0;
  if (is_held) shown_ = goal_;
}

}  // namespace kinescope::app
