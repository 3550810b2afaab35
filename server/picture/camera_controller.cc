#include "server/picture/camera_controller.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "urdf/heading.h"

namespace kinescope::app {
namespace {

double SecsBetween(std::int64_t from_nanos, std::int64_t to_nanos) {
  return Secs(to_nanos - from_nanos);
}

// Of a first-order lag: the share of the way to go that is gone in `dt`, however often it is asked.
double ShareGone(double dt_secs, double lag_secs) {
  return lag_secs > 0 ? 1 - std::exp(-std::max(0.0, dt_secs) / lag_secs) : 1;
}

std::vector<Ball> ShownBalls(const SceneState& state, const std::vector<Ball>& beside) {
  std::vector<Ball> balls = render::BallsOf(state);
  balls.insert(balls.end(), beside.begin(), beside.end());
  return balls;
}

}  // namespace

CameraController::CameraController(const CameraChoice& camera, const CameraOptions& options,
                                   Fit fit)
    : camera_(camera.text),
      place_(camera.place),
      is_orthographic_(*options.projection),
      is_one_turn_(options.orbit->is_one_turn),
      orbit_rad_per_sec_(options.orbit->degrees_per_sec * M_PI / 180),
      fit_(*options.fit),
      frame_(*options.camera_frame),
      base_(*options.camera_tf) {
  if (camera.is_key_file) keys_ = ReadCameraKeys(camera_);
  if (options.fov) {
    fov_rad_ = *options.fov * M_PI / 180;
    if (place_) place_->vertical_fov_rad = *fov_rad_;
  }
  if (options.follow) follow_secs_ = *options.follow;
  holds_view_ = fit_ == Fit::kAuto && fit == Fit::kOff && IsNamed();
  if (fit_ == Fit::kAuto) fit_ = IsNamed() ? fit : Fit::kOff;
  if (fit_ != Fit::kOff && !keys_.empty()) {
    throw UsageError("--fit=" + options.fit.ToText() +
                     ": the file of keys sets the camera's position; leave one of them out");
  }
}

std::string CameraController::name() const {
  if (place_) return "";
  return keys_.empty() ? camera_ : std::filesystem::path(camera_).filename().string();
}

std::string CameraController::HeadingNote(const SceneState& state) const {
  const bool is_turned = !place_ && frame_ != CameraFrame::kWorld && !state.people.empty();
  if (!is_turned) return "";
  switch (urdf::HeadingOf(state.people.front().links).rule) {
    case urdf::HeadingRule::kUpright: break;
    case urdf::HeadingRule::kLyingOnSide:
      return "the person lies on a side: for named cameras the front is where the face looks";
    case urdf::HeadingRule::kLyingLevel:
      return "the person lies on the back or the belly: for named cameras the front is the "
             "person's left side";
    case urdf::HeadingRule::kUndefined:
      return "the person is upside down, so the heading is undefined: named cameras stay with the "
             "axes of the world";
  }
  return "";
}

void CameraController::Prescan(const SceneState& state, const std::vector<Ball>& beside) {
  if (!prescan_start_nanos_) prescan_start_nanos_ = state.stamp_nanos;
  const double secs = SecsBetween(*prescan_start_nanos_, state.stamp_nanos);
  clip_secs_ = std::max(clip_secs_, secs);
  clip_extent_.extend(state.extent);
  constexpr double kInterval = 1.0 / 30;  // s, in which nothing moves far
  if (fit_ != Fit::kClip || secs < next_prescan_secs_) return;
  next_prescan_secs_ = secs + kInterval;
  const Eigen::Vector3d middle = prescan_follower_.Follow(state, secs, follow_secs_).middle;
  for (const Ball& ball : ShownBalls(state, beside)) {
    clip_.Add(ball);
    clip_around_people_.Add({ball.center - middle, ball.radius});
  }
}

// What named cameras show instead of people; empty: there are some, or there is nothing.
Eigen::AlignedBox3d CameraController::Extent(const SceneState& state) const {
  if (!state.people.empty()) return {};
  return clip_extent_.isEmpty() ? state.extent : clip_extent_;
}

// Turned with the person; -0 would change the last bits of a camera that is not.
render::Camera CameraController::NamedAt(const std::string& name,
                                         const render::GroundExtent& ground) const {
  const render::Camera camera = render::NamedCameraAt(name, ground);
  return heading_rad_.value_or(0) == 0 ? camera : render::Turned(camera, *heading_rad_);
}

// Before its frame is found, as if that were at the origin.
render::Camera CameraController::OnBase(render::Camera camera, const SceneState& state) const {
  if (base_.frame.empty() || !state.camera_base) return camera;
  const Eigen::Quaterniond& q = state.camera_base->orientation;
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  if (base_.turn == CameraBase::Turn::kFull) turn = q;
  if (base_.turn == CameraBase::Turn::kHeading) {
    const Eigen::Vector3d ahead = q * Eigen::Vector3d::UnitX();
    turn = Eigen::AngleAxisd(std::atan2(ahead.y(), ahead.x()), Eigen::Vector3d::UnitZ());
  }
  camera.position = state.camera_base->position + turn * camera.position;
  camera.target = state.camera_base->position + turn * camera.target;
  camera.up = turn * camera.up;
  return camera;
}

// Where it stands but for orbit and frame.
render::Camera CameraController::Placed(const SceneState& state, const render::GroundExtent& ground,
                                        double secs) const {
  if (!keys_.empty()) {
    std::vector<render::CameraKey> keys;
    for (const CameraKeySpec& spec : keys_) {
      render::Camera camera =
          spec.name.empty() ? OnBase(spec.place, state) : NamedAt(spec.name, ground);
      if (!spec.name.empty() && spec.fov_rad) camera = render::WithFov(camera, *spec.fov_rad);
      keys.push_back({spec.secs, camera, spec.ease});
    }
    return render::AlongPath(keys, secs);
  }
  if (place_) return OnBase(*place_, state);
  // Robots have no ground: the view is as large as they are.
  const Eigen::AlignedBox3d extent = Extent(state);
  if (!extent.isEmpty()) return render::NamedCameraAround(camera_, extent);
  // Only the direction counts then; wherever people are, it is the same to the last bit.
  return fit_ == Fit::kClip ? NamedAt(camera_, {}) : NamedAt(camera_, ground);
}

// It stands still unless people would be much smaller for it; then it goes with them.
render::Camera CameraController::ForClip(const render::Camera& camera,
                                         const render::GroundExtent& ground, double aspect) const {
  constexpr double kMuchSmaller = 1.3;
  render::Camera still = render::Framing(camera, clip_.balls(), aspect, free_area_);
  render::Camera with_people =
      render::Framing(camera, clip_around_people_.balls(), aspect, free_area_);
  if (render::ShownHeight(still) < kMuchSmaller * render::ShownHeight(with_people)) return still;
  with_people.position += ground.middle;
  with_people.target += ground.middle;
  return with_people;
}

render::Camera CameraController::Lensed(render::Camera camera, double secs) const {
  if (fov_rad_ && IsNamed()) camera = render::WithFov(camera, *fov_rad_);
  if (is_orthographic_) camera = render::Orthographic(camera);
  const double turn_rate =
      is_one_turn_ && clip_secs_ > 0 ? 2 * M_PI / clip_secs_ : orbit_rad_per_sec_;
  return turn_rate != 0 ? render::Turned(camera, turn_rate * secs) : camera;
}

// With lens, turn and frame, which are the same for all.
render::Camera CameraController::Finished(const render::Camera& placed,
                                          const render::GroundExtent& ground,
                                          const SceneState& state, double secs, double aspect,
                                          const std::vector<Ball>& beside) const {
  const render::Camera camera = Lensed(placed, secs);
  // A given position or lens is kept.
  if (IsNamed() && !Extent(state).isEmpty()) return render::WithWholeExtent(camera, aspect);
  if (fit_ == Fit::kClip && !clip_.balls().empty()) return ForClip(camera, ground, aspect);
  if (fit_ == Fit::kNow) {
    const std::vector<Ball> shown = ShownBalls(state, beside);
    if (!shown.empty()) return render::Framing(camera, shown, aspect, free_area_);
  }
  // A named camera keeps the person in the picture.
  return IsNamed() ? render::ForAspect(camera, aspect) : camera;
}

void CameraController::StartTime(const SceneState& state) {
  if (!start_nanos_ && state.stamp_nanos != 0) start_nanos_ = state.stamp_nanos;
}

double CameraController::SecsOf(const SceneState& state) {
  StartTime(state);
  return start_nanos_ ? std::max(0.0, SecsBetween(*start_nanos_, state.stamp_nanos)) : 0;
}

const render::GroundExtent& CameraController::Follower::Follow(const SceneState& state, double secs,
                                                               std::optional<double> lag_secs) {
  if (!lag_secs) return steady.Follow(state);
  const render::GroundExtent now = render::GroundExtentOf(state);
  if (!has_met) {
    has_met = !state.people.empty();
    followed = now;
    first_middle = now.middle;
  } else if (!state.people.empty()) {
    const double share = ShareGone(secs - at_secs, *lag_secs);
    followed.middle += share * (now.middle - followed.middle);
    followed.radius += share * (now.radius - followed.radius);
  }
  at_secs = secs;
  return followed;
}

// In CameraFrame::kPerson with a lag, so that a turning person does not throw the picture about.
void CameraController::FollowHeading(const SceneState& state, double secs) {
  constexpr double kLagSecs = 0.7;
  if (frame_ == CameraFrame::kWorld || state.people.empty()) return;
  if (heading_rad_ && frame_ == CameraFrame::kStart) return;
  const std::optional<double> now = urdf::HeadingOf(state.people.front().links).rad;
  if (!now) return;
  if (frame_ == CameraFrame::kStart) {
    heading_rad_ = AlongFloorLines(*now);
    return;
  }
  const double before = heading_rad_.value_or(*now);
  const double way = std::remainder(*now - before, 2 * M_PI);
  heading_rad_ = before + way * ShareGone(secs - heading_at_secs_, kLagSecs);
  heading_at_secs_ = secs;
}

render::Camera CameraController::AimAt(const render::GroundExtent& ground, const SceneState& state,
                                       double secs, double aspect,
                                       const std::vector<Ball>& beside) const {
  render::Camera camera = Placed(state, ground, secs);
  if (place_ && follow_secs_) {
    const Eigen::Vector3d shift = ground.middle - follower_.first_middle;
    camera.position += shift;
    camera.target += shift;
  }
  return Finished(camera, ground, state, secs, aspect, beside);
}

// Not without people: what there is is held already.
bool CameraController::HoldsView(const SceneState& state) const {
  return holds_view_ && Extent(state).isEmpty();
}

render::Camera CameraController::Aim(const SceneState& state, double aspect,
                                     const std::vector<Ball>& beside) {
  const double secs = SecsOf(state);
  FollowHeading(state, secs);
  const render::GroundExtent& ground = follower_.Follow(state, secs, follow_secs_);
  if (!HoldsView(state)) return AimAt(ground, state, secs, aspect, beside);
  const render::Camera camera = Lensed(NamedAt(camera_, {}), secs);
  const render::ViewHull needed = render::NeededHull(state, camera);
  const render::ViewPlace place =
      HeldPlace(!state.people.empty(), needed, camera, {aspect, free_area_}, secs);
  return render::MovedTo(place, camera, ground.middle);
}

// Before the first person comes, nothing is held.
render::ViewPlace CameraController::HeldPlace(bool has_people, const render::ViewHull& needed,
                                              const render::Camera& camera,
                                              const render::ViewShape& shape, double secs) {
  const bool has_met = has_people || !held_view_.shown().is_empty();
  return has_met ? held_view_.Follow(needed, camera, shape, secs)
                 : render::PlaceFor(needed, camera, shape);
}

render::Camera CameraController::AimLive(const SceneState& state, const render::ViewShape& live,
                                         const std::optional<render::ViewShape>& shape) {
  const double secs = SecsOf(state);
  heading_rad_ = LiveHeading(state);
  if (HoldsView(state)) return AimHeld(state, secs, live, shape);
  const render::ViewShape& own = shape.value_or(live);
  free_area_ = own.area;
  if (follow_secs_) {
    return AimAt(follower_.Follow(state, secs, follow_secs_), state, secs, own.aspect, {});
  }
  const render::GroundExtent& held = held_.Follow(state, secs, live.aspect);
  // A narrower picture would lack who is at the sides of the live one.
  const bool is_narrow = own.aspect < live.aspect;
  return AimAt(is_narrow ? render::GroundExtentOf(state) : held, state, secs, own.aspect, {});
}

render::Camera CameraController::AimHeld(const SceneState& state, double secs,
                                         const render::ViewShape& live,
                                         const std::optional<render::ViewShape>& shape) {
  const render::Camera camera = Lensed(NamedAt(camera_, {}), secs);
  const render::ViewHull needed = render::NeededHull(state, camera);
  render::ViewPlace place = HeldPlace(!state.people.empty(), needed, camera, live, secs);
  render::ViewHull shown = held_view_.shown();
  shown.Add(needed);
  const render::GroundExtent people = render::GroundExtentOf(state);
  Eigen::Vector3d middle;
  if (follow_secs_) {
    middle = follower_.Follow(state, secs, follow_secs_).middle;
  } else {
    render::ShownRoom room;
    room.height = place.height;
    room.reach = std::max(room.reach, shown.half_width() - people.radius);
    middle = held_.Follow(state, secs, live.aspect, room).middle;
    place.height = held_.height();
  }
  const bool is_other = shape && shape->aspect != live.aspect;
  if (!is_other) {
    place = render::BesideCorners(place, needed, people.middle - middle, camera, live);
    return render::MovedTo(place, camera, middle);
  }
  return render::MovedTo(render::PlaceFor(shown, camera, *shape), camera, people.middle);
}

// As the page has it, which the state is sent to.
double CameraController::LiveHeading(const SceneState& state) const {
  return frame_ == CameraFrame::kWorld ? 0 : state.view_heading;
}

render::Camera CameraController::Alone(const SceneState& state, double secs, double aspect,
                                       const std::vector<Ball>& beside) const {
  const render::GroundExtent ground = render::GroundExtentOf(state);
  if (!HoldsView(state)) {
    return Finished(Placed(state, ground, secs), ground, state, secs, aspect, beside);
  }
  const render::Camera camera = Lensed(NamedAt(camera_, {}), secs);
  const render::ViewHull needed = render::NeededHull(state, camera);
  const render::ViewPlace place = render::PlaceFor(needed, camera, {aspect, free_area_});
  return render::MovedTo(place, camera, ground.middle);
}

render::Camera CameraController::OnlyLive(const SceneState& state,
                                          const render::ViewShape& shape) const {
  CameraController alone = *this;
  alone.heading_rad_ = LiveHeading(state);
  alone.free_area_ = shape.area;
  return alone.Alone(state, 0, shape.aspect, {});
}

render::Camera CameraController::Only(const SceneState& state, double secs, double aspect,
                                      const std::vector<Ball>& beside) const {
  CameraController alone = *this;
  alone.heading_rad_.reset();
  alone.FollowHeading(state, secs);
  return alone.Alone(state, secs, aspect, beside);
}

}  // namespace kinescope::app
