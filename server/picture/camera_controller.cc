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

}  // namespace

CameraController::CameraController(const CameraChoice& camera, const CameraOptions& options)
    : camera_(camera.text),
      place_(camera.place),
      is_orthographic_(*options.projection),
      is_one_turn_(options.orbit->is_one_turn),
      orbit_rad_per_sec_(options.orbit->degrees_per_sec * M_PI / 180),
      fit_(*options.fit) {
  if (options.camera_frame) frame_ = *options.camera_frame;
  if (camera.is_key_file) keys_ = ReadCameraKeys(camera_);
  if (options.fov) {
    fov_rad_ = *options.fov * M_PI / 180;
    if (place_) place_->vertical_fov_rad = *fov_rad_;
  }
  if (options.follow) follow_secs_ = *options.follow;
  if (fit_ != Fit::kOff && !keys_.empty()) {
    throw UsageError("--fit=" + options.fit.ToText() +
                     ": the file of keys sets the camera's position; leave one of them out");
  }
}

std::string CameraController::name() const {
  if (place_) return "";
  return keys_.empty() ? camera_ : std::filesystem::path(camera_).filename().string();
}

void CameraController::Prescan(const SceneState& state) {
  if (!prescan_start_nanos_) prescan_start_nanos_ = state.stamp_nanos;
  clip_secs_ = std::max(clip_secs_, SecsBetween(*prescan_start_nanos_, state.stamp_nanos));
  const Eigen::AlignedBox3d box = render::BoxOf(state);
  if (!box.isEmpty()) clip_box_.extend(box);
}

// Turned with the person; -0 would change the last bits of a camera that is not.
render::Camera CameraController::NamedAt(const std::string& name,
                                         const render::GroundExtent& ground) const {
  const render::Camera camera = render::NamedCameraAt(name, ground);
  return heading_rad_.value_or(0) == 0 ? camera : render::Turned(camera, *heading_rad_);
}

// Where it stands but for orbit and frame.
render::Camera CameraController::Placed(const SceneState& state, const render::GroundExtent& ground,
                                        double secs) const {
  if (!keys_.empty()) {
    std::vector<render::CameraKey> keys;
    for (const CameraKeySpec& spec : keys_) {
      render::Camera camera = spec.name.empty() ? spec.place : NamedAt(spec.name, ground);
      if (!spec.name.empty() && spec.fov_rad) camera = render::WithFov(camera, *spec.fov_rad);
      keys.push_back({spec.secs, camera, spec.ease});
    }
    return render::AlongPath(keys, secs);
  }
  if (place_) return *place_;
  // Only the direction counts then; wherever people are, it is the same to the last bit.
  if (fit_ == Fit::kClip) return NamedAt(camera_, {});
  // Robots have no ground: the view is as large as they are.
  const bool is_of_robots = state.people.empty() && !state.robots.empty();
  return is_of_robots ? render::NamedCamera(camera_, state) : NamedAt(camera_, ground);
}

// With lens, turn and frame, which are the same for all.
render::Camera CameraController::Finished(render::Camera camera, const SceneState& state,
                                          double secs, double aspect) const {
  if (fov_rad_ && IsNamed()) camera = render::WithFov(camera, *fov_rad_);
  if (is_orthographic_) camera = render::Orthographic(camera);
  const double turn_rate =
      is_one_turn_ && clip_secs_ > 0 ? 2 * M_PI / clip_secs_ : orbit_rad_per_sec_;
  if (turn_rate != 0) camera = render::Turned(camera, turn_rate * secs);
  const Eigen::AlignedBox3d box = fit_ == Fit::kNow    ? render::BoxOf(state)
                                  : fit_ == Fit::kClip ? clip_box_
                                                       : Eigen::AlignedBox3d();
  if (!box.isEmpty()) return render::Framing(camera, box, aspect);
  // A given position or lens is kept; a named camera keeps the person in the picture.
  return IsNamed() ? render::ForAspect(camera, aspect) : camera;
}

void CameraController::StartTime(const SceneState& state) {
  if (!start_nanos_ && state.stamp_nanos != 0) start_nanos_ = state.stamp_nanos;
}

double CameraController::SecsOf(const SceneState& state) {
  StartTime(state);
  return start_nanos_ ? std::max(0.0, SecsBetween(*start_nanos_, state.stamp_nanos)) : 0;
}

const render::GroundExtent& CameraController::Follow(const SceneState& state, double secs) {
  const render::GroundExtent now = render::GroundExtentOf(state);
  if (!has_met_) {
    has_met_ = !state.people.empty();
    followed_ = now;
    first_middle_ = now.middle;
  } else if (!state.people.empty()) {
    const double share = ShareGone(secs - followed_at_secs_, *follow_secs_);
    followed_.middle += share * (now.middle - followed_.middle);
    followed_.radius += share * (now.radius - followed_.radius);
  }
  followed_at_secs_ = secs;
  return followed_;
}

// In CameraFrame::kPerson with a lag, so that a turning person does not throw the picture about.
void CameraController::FollowHeading(const SceneState& state, double secs, CameraFrame frame) {
  constexpr double kLagSecs = 0.7;
  if (frame == CameraFrame::kWorld || state.people.empty()) return;
  if (heading_rad_ && frame == CameraFrame::kStart) return;
  const std::optional<double> now = urdf::HeadingOf(state.people.front().links);
  if (!now) return;
  if (frame == CameraFrame::kStart) {
    // Nearly along the floor's lines is meant to be along them: a walking pelvis turns by that
    // much.
    constexpr double kRight = M_PI / 2, kNearly = 8 * M_PI / 180;
    const double along = kRight * std::round(*now / kRight);
    heading_rad_ = std::abs(*now - along) < kNearly ? along : *now;
    return;
  }
  const double before = heading_rad_.value_or(*now);
  const double way = std::remainder(*now - before, 2 * M_PI);
  heading_rad_ = before + way * ShareGone(secs - heading_at_secs_, kLagSecs);
  heading_at_secs_ = secs;
}

render::Camera CameraController::AimAt(const render::GroundExtent& ground, const SceneState& state,
                                       double secs, double aspect) const {
  render::Camera camera = Placed(state, ground, secs);
  if (place_ && follow_secs_) {
    const Eigen::Vector3d shift = ground.middle - first_middle_;
    camera.position += shift;
    camera.target += shift;
  }
  return Finished(camera, state, secs, aspect);
}

render::Camera CameraController::Aim(const SceneState& state, double aspect) {
  const double secs = SecsOf(state);
  FollowHeading(state, secs, frame_.value_or(CameraFrame::kStart));
  return AimAt(follow_secs_ ? Follow(state, secs) : steady_.Follow(state), state, secs, aspect);
}

render::Camera CameraController::AimLive(const SceneState& state, double live_aspect,
                                         double aspect) {
  const double secs = SecsOf(state);
  // The page and RViz show the world's views.
  FollowHeading(state, secs, frame_.value_or(CameraFrame::kWorld));
  if (follow_secs_) return AimAt(Follow(state, secs), state, secs, aspect);
  const render::GroundExtent& held = held_.Follow(state, secs, live_aspect);
  return AimAt(aspect < live_aspect ? render::GroundExtentOf(state) : held, state, secs, aspect);
}

render::Camera CameraController::Only(const SceneState& state, double secs, double aspect) const {
  CameraController alone = *this;
  alone.heading_rad_.reset();
  alone.FollowHeading(state, secs, frame_.value_or(CameraFrame::kStart));
  return alone.Finished(alone.Placed(state, render::GroundExtentOf(state), secs), state, secs,
                        aspect);
}

}  // namespace kinescope::app
