#include "render/camera/held_view.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/person_outline.h"
#include "render/camera/spring.h"

namespace kinescope::render {
namespace {

using Eigen::Vector3d;

constexpr double kFill = 0.76, kMostFill = 0.85, kLeastFill = 0.65;  // of the free height or width
constexpr double kLeastShownHeight = 0.9;                            // m, that is shown
constexpr double kReach = 3;                                         // m
constexpr double kShortWait = 2, kLongWait = 10;                     // s
constexpr double kRegret = 10;          // s after coming nearer, in which going back was a mistake
constexpr double kBack = 0.9;           // of the height from which it came nearer
constexpr double kRoomInterval = 0.1;   // s, between hulls that are remembered
constexpr double kRoomArrived = 0.005;  // m and m/s
// Of a glide. More room is needed sooner than less.
constexpr double kQuick = 4, kSlow = 1.5;  // 1/s

struct Direction {
  Vector3d way;
  double length = 1;

  double ReachOf(const Ball& ball) const { return way.dot(ball.center) + length * ball.radius; }
};

// To the planes through the eye that touch people: their slopes are those of the sides of pictures,
// and of a part of them.
const std::vector<Direction>& Directions() {
  static const std::vector<Direction> directions = [] {
    std::vector<Direction> all = {{{0, 0, 1}}, {{0, 0, -1}}};
    for (const double slope : {-0.5, -0.35, -0.2, -0.1, 0.0, 0.1, 0.2, 0.35, 0.5}) {
      for (const double side : {-1.0, 1.0}) {
        all.push_back({{side, 0, slope}, std::hypot(1, slope)});
        all.push_back({{0, side, slope}, std::hypot(1, slope)});
      }
    }
    return all;
  }();
  return directions;
}

// In the world, as if the people's middle were its origin.
std::vector<Ball> InWorld(const std::vector<Ball>& balls, const Camera& camera) {
  const Eigen::Matrix3d axes = AxesOf(camera);
  std::vector<Ball> in_world = balls;
  for (Ball& ball : in_world) ball.center = axes.transpose() * ball.center;
  return in_world;
}

bool IsWithin(const ViewHull& hull, const ViewPlace& place, const Camera& camera,
              const ViewShape& shape) {
  return AreWithin(MovedTo(place, camera, Vector3d::Zero()), InWorld(hull.balls(), camera),
                   shape.aspect, shape.area, kMostFill);
}

}  // namespace

void ViewHull::Add(const Ball& ball) {
  if (is_empty()) balls_.assign(Directions().size(), ball);
  for (std::size_t i = 0; i < balls_.size(); ++i) {
    const Direction& direction = Directions()[i];
    if (direction.ReachOf(ball) > direction.ReachOf(balls_[i])) balls_[i] = ball;
  }
}

void ViewHull::Add(const ViewHull& other) {
  if (is_empty()) balls_ = other.balls_;
  for (std::size_t i = 0; i < other.balls_.size(); ++i) {
    const Direction& direction = Directions()[i];
    if (direction.ReachOf(other.balls_[i]) > direction.ReachOf(balls_[i])) {
      balls_[i] = other.balls_[i];
    }
  }
}

double ViewHull::half_width() const {
  double widest = 0;
  for (const Ball& ball : balls_) {
    widest = std::max(widest, std::abs(ball.center.x()) + ball.radius);
  }
  return widest;
}

ViewHull NeededHull(const SceneState& state, const Camera& camera) {
  const Eigen::Matrix3d axes = AxesOf(camera);
  const Vector3d middle = GroundExtentOf(state).middle;
  ViewHull hull;
  const auto add = [&](const Ball& ball) {
    hull.Add({axes * (ball.center - middle), ball.radius});
  };
  for (const PersonState* person : FramedPeople(state)) {
    const Vector3d& pelvis = person->links[urdf::kPelvis].position;
    for (const Ball& ball : BallsOf(*person)) {
      const bool is_near = (ball.center - pelvis).norm() + ball.radius < kReach;  // false for NaN
      if (is_near) add(ball);
    }
  }
  if (!hull.is_empty()) return hull;
  constexpr double kHalfWidth = 0.35;  // m
  for (const double z : {kHalfWidth, kGroupFraming.height_m * kFill - kHalfWidth}) {
    add({middle + Vector3d(0, 0, z), kHalfWidth});
  }
  return hull;
}

ViewPlace PlaceFor(const ViewHull& hull, const Camera& camera, const ViewShape& shape) {
  const auto place_of = [&](const std::vector<Ball>& shown) -> ViewPlace {
    const Camera framed =
        Framing(camera, InWorld(shown, camera), shape.aspect, shape.area, {kFill, true});
    const Vector3d eye = AxesOf(camera) * framed.position;
    const double slope = std::tan(0.5 * camera.vertical_fov_rad);
    return {eye.x(), eye.y(),
            camera.is_orthographic() ? framed.ortho_height_m : -2 * slope * eye.z()};
  };
  const ViewPlace place = place_of(hull.balls());
  if (place.height >= kLeastShownHeight) return place;
  // With a ball of that size around their middle.
  std::vector<Ball> larger = hull.balls();
  Vector3d low = larger.front().center, high = low;
  for (const Ball& ball : larger) {
    low = low.cwiseMin(ball.center);
    high = high.cwiseMax(ball.center);
  }
  larger.push_back({0.5 * (low + high), 0.5 * kFill * kLeastShownHeight});
  return place_of(larger);
}

Camera MovedTo(const ViewPlace& place, const Camera& camera, const Vector3d& middle) {
  const Eigen::Matrix3d axes = AxesOf(camera);
  const double slope = std::tan(0.5 * camera.vertical_fov_rad);
  double distance = 0.5 * place.height / slope;
  Camera moved = camera;
  if (camera.is_orthographic()) {
    moved.ortho_height_m = place.height;
    distance = std::max((camera.position - camera.target).norm(), 2 * place.height);
  }
  moved.target = middle + axes.transpose() * Vector3d(place.right, place.up, 0);
  moved.position = moved.target - distance * axes.row(2).transpose();
  moved.near_m = std::min(camera.near_m, 0.02 * distance);
  moved.far_m = std::max(camera.far_m, 4 * distance);
  return moved;
}

ViewPlace BesideCorners(ViewPlace place, const ViewHull& people, const Vector3d& away,
                        const Camera& camera, const ViewShape& shape) {
  std::vector<Ball> balls = InWorld(people.balls(), camera);
  for (Ball& ball : balls) ball.center += away;
  place.right -=
      StepBesideCorners(MovedTo(place, camera, Vector3d::Zero()), balls, shape.aspect, shape.area);
  return place;
}

// Of what was needed since `wait_`, and now.
ViewHull HeldView::Recent(const ViewHull& needed, double secs) {
  if (seen_.empty() || secs - seen_.back().secs >= kRoomInterval) seen_.push_back({secs, needed});
  while (secs - seen_.front().secs > kLongWait) seen_.pop_front();
  ViewHull recent = needed;
  for (const Seen& seen : seen_) {
    if (secs - seen.secs <= wait_) recent.Add(seen.needed);
  }
  return recent;
}

void HeldView::LearnToWait(const ViewPlace& goal, bool is_too_much, double secs) {
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

void HeldView::GlideTo(const ViewPlace& goal, double stiffness, double dt) {
  bool has_arrived = true;
  for (double ViewPlace::*part : {&ViewPlace::right, &ViewPlace::up, &ViewPlace::height}) {
    double &value = held_.*part, &speed = speed_.*part;
    Glide(value, speed, goal.*part, stiffness, dt);
    has_arrived = has_arrived && std::abs(value - goal.*part) < kRoomArrived &&
                  std::abs(speed) < kRoomArrived;
  }
  if (!has_arrived) return;
  is_gliding_ = false;
  speed_ = {};
}

const ViewPlace& HeldView::Follow(const ViewHull& needed, const Camera& camera,
                                  const ViewShape& shape, double secs) {
  const double dt = std::max(0.0, secs - at_secs_);
  if (seen_.empty() || secs < at_secs_) {
    *this = {};
    shown_ = needed;
    held_ = PlaceFor(needed, camera, shape);
    wait_ = kShortWait;
  }
  at_secs_ = secs;
  const ViewHull recent = Recent(needed, secs);
  const ViewPlace goal = PlaceFor(recent, camera, shape);
  const bool is_too_little = !IsWithin(recent, held_, camera, shape);
  const bool is_too_much = goal.height < kLeastFill / kFill * held_.height;
  LearnToWait(goal, is_too_much, secs);
  is_gliding_ = is_gliding_ || is_too_little || is_too_much;
  if (!is_gliding_) return held_;
  shown_ = recent;
  GlideTo(goal, is_too_little || goal.height >= held_.height ? kQuick : kSlow, dt);
  return held_;
}

}  // namespace kinescope::render
