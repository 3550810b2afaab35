#include "render/camera/held_extent.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "render/camera/spring.h"

namespace kinescope::render {
namespace {

constexpr double kMemory = 10;       // s
constexpr double kFastest = 3;       // m/s
constexpr double kInterval = 0.1;    // s, between places that are remembered
constexpr double kAhead = 0.5;       // s, that the camera looks ahead to start in time
constexpr double kSlack = 0.3;       // m, of the margin, that people may use up by then
constexpr double kTolerance = 0.05;  // m, for those who go round at the edge of the picture
constexpr double kSmaller = 1.35;  // times that people may be smaller so that the camera can stand
constexpr double kNearer = 0.8;    // of the shown height: then it is worth to come nearer
constexpr double kSlope = 0.27;    // of half the height, in the pictures of named cameras

// Of a glide.
constexpr double kStiffness = 4;        // 1/s; half of the way takes 0.42 s
constexpr double kArrived = 0.005;      // m
constexpr double kArrivedSpeed = 0.01;  // m/s

// A picture of people who stand within `radius` of their middle.
struct Picture {
  double aspect, radius;
  ShownRoom room;
};

// That shows all ground around `aimed`, whose nearer half comes closer than its middle.
double HeightFor(const GroundExtent& aimed, const Picture& picture) {
  const double more = aimed.radius - picture.radius;
  if (more <= 0) return picture.room.height;
  const double width = 2 * (aimed.radius + picture.room.reach);
  return std::max(picture.room.height, width / picture.aspect + kSlope * more);
}

// The most, for a camera that stands still: of a group, as if the picture were narrow.
double MostHeight(const Picture& picture) {
  const double width = 2 * (picture.radius + kGroupFraming.margin_m);
  return kSmaller * std::max(picture.room.height, width / kGroupFraming.narrowest_aspect);
}

// The radius within which people are in a picture that is aimed at `aimed`.
double VisibleRadius(const GroundExtent& aimed, const Picture& picture) {
  return std::max(0.5 * picture.aspect * HeightFor(aimed, picture) - picture.room.reach,
                  aimed.radius);
}

bool Contains(const GroundExtent& aimed, const GroundExtent& people, const Picture& picture,
              double slack = 0) {
  const double away = (people.middle - aimed.middle).norm();
  return away + people.radius <= VisibleRadius(aimed, picture) + slack;
}

// The nearest aim at the middle of `recent` that shows all of it.
GroundExtent Around(const GroundExtent& recent, const Picture& picture) {
  GroundExtent nearest{recent.middle, picture.radius};
  if (Contains(nearest, recent, picture)) return nearest;
  return {recent.middle, std::max(picture.radius, recent.radius)};
}

}  // namespace

void HeldGroundExtent::Remember(const GroundExtent& people, double secs) {
  if (!seen_.empty() && secs < seen_.back().secs) seen_.clear();
  if (seen_.empty() || secs - seen_.back().secs >= kInterval) seen_.push_back({secs, people});
  while (secs - seen_.front().secs > kMemory) seen_.pop_front();
}

GroundExtent HeldGroundExtent::Recent() const {
  Eigen::AlignedBox3d box;
  for (const Seen& seen : seen_) {
    const Eigen::Vector3d reach(seen.people.radius, seen.people.radius, 0);
    box.extend(Eigen::Vector3d(seen.people.middle - reach));
    box.extend(Eigen::Vector3d(seen.people.middle + reach));
  }
  GroundExtent recent{box.center(), 0};
  for (const Seen& seen : seen_) {
    const double away = (seen.people.middle - recent.middle).norm();
    recent.radius = std::max(recent.radius, away + seen.people.radius);
  }
  return recent;
}

// m/s, of the people's middle over the last half second.
Eigen::Vector3d HeldGroundExtent::Velocity() const {
  const Seen& last = seen_.back();
  const auto first = std::find_if(seen_.begin(), seen_.end(), [&](const Seen& seen) {
    return last.secs - seen.secs < 0.5 + kInterval;
  });
  if (last.secs - first->secs < kInterval) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d velocity =
      (last.people.middle - first->people.middle) / (last.secs - first->secs);
  // Who is faster has not run, but was put elsewhere, or has come or gone.
  return velocity * (kFastest / std::max(velocity.norm(), kFastest));
}

void HeldGroundExtent::GlideTo(const GroundExtent& goal, double dt) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    Glide(held_.middle[axis], speed_.middle[axis], goal.middle[axis], kStiffness, dt);
  }
  Glide(held_.radius, speed_.radius, goal.radius, kStiffness, dt);
  const bool has_arrived = (held_.middle - goal.middle).norm() < kArrived &&
                           std::abs(held_.radius - goal.radius) < kArrived &&
                           speed_.middle.norm() < kArrivedSpeed &&
                           std::abs(speed_.radius) < kArrivedSpeed;
  if (!has_arrived) return;
  is_gliding_ = false;
  speed_ = {};
}

const GroundExtent& HeldGroundExtent::Follow(const SceneState& state, double secs, double aspect,
                                             const ShownRoom& room) {
  const GroundExtent people = GroundExtentOf(state);
  const Picture picture{aspect, people.radius, room};
  const double dt = std::max(0.0, secs - at_secs_);
  at_secs_ = secs;
  height_ = room.height;
  if (!has_people_) {
    has_people_ = !state.people.empty();
    held_ = people;
  }
  if (state.people.empty()) return held_;
  Remember(people, secs);
  const Eigen::Vector3d velocity = Velocity();
  const GroundExtent ahead{people.middle + kAhead * velocity, people.radius};
  const GroundExtent still = Around(Recent(), picture);
  const bool can_stand =
      HeightFor(still, picture) <= MostHeight(picture) && Contains(still, ahead, picture, kSlack);
  // A spring that follows a steady motion lags by twice its time constant.
  const GroundExtent along{people.middle + 2 / kStiffness * velocity, people.radius};
  const GroundExtent& goal = can_stand ? still : along;
  const bool is_far = HeightFor(goal, picture) < kNearer * HeightFor(held_, picture);
  const bool leaves =
      !Contains(held_, people, picture, kTolerance) || !Contains(held_, ahead, picture, kSlack);
  is_gliding_ = is_gliding_ || is_far || leaves;
  if (is_gliding_) GlideTo(goal, dt);
  height_ = HeightFor(held_, picture);
  return held_;
}

}  // namespace kinescope::render
