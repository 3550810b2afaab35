/// Where the camera stands, scene after scene: a name, a fixed place or a path, and what moves it
/// besides (turning, following, framing). One thread.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/scene_state.h"
#include "render/camera/camera.h"
#include "render/camera/framing.h"
#include "render/camera/held_extent.h"
#include "render/camera/held_view.h"
#include "server/picture/camera_keys.h"
#include "server/picture/camera_options.h"

namespace kinescope::app {

class CameraController {
 public:
  /// `fit`: what Fit::kAuto means for a named camera; given places and paths are kept.
  /// @throws UsageError naming the file of keys and what is wrong in it, or options that do not fit
  /// together.
  CameraController(const CameraChoice& camera, const CameraOptions& options, Fit fit = Fit::kOff);

  /// Where the pictures have room for people; without it: everywhere.
  void SetFreeArea(const render::FreeArea& area) { free_area_ = area; }

  /// Whether Aim needs to know the whole clip before its first picture.
  bool needs_prescan() const { return fit_ == Fit::kClip || is_one_turn_; }
  /// Once for every scene of the clip, in order, before the first Aim. `beside`: what is shown
  /// besides the scene.
  void Prescan(const SceneState& state, const std::vector<Ball>& beside = {});

  /// Time begins with the first state that has a stamp and was passed to this function or to Aim.
  /// Call it for every state of a live source, so that time runs while no pictures are taken.
  void StartTime(const SceneState& state);

  /// Once per picture of a clip, in order. Time is that of the states' stamps.
  /// @param aspect width / height of the picture
  render::Camera Aim(const SceneState& state, double aspect, const std::vector<Ball>& beside = {});

  /// The same for live pictures, whose future is not known: the camera stands still as long as it
  /// can (HeldGroundExtent, HeldView).
  /// @param live   of the live picture, for which the camera stands still
  /// @param shape  of another picture, which shows the same people. With the aspect of the live one
  ///               it has its camera, else one that is aimed at the people.
  render::Camera AimLive(const SceneState& state, const render::ViewShape& live,
                         const std::optional<render::ViewShape>& shape = std::nullopt);

  /// For one live picture alone, which has the heading of all live pictures.
  render::Camera OnlyLive(const SceneState& state, const render::ViewShape& shape) const;

  /// For one picture alone, `secs` after the clip's start: nothing lags.
  render::Camera Only(const SceneState& state, double secs, double aspect,
                      const std::vector<Ball>& beside = {}) const;

  /// How named cameras are turned where the person of the first picture does not stand or sit; ""
  /// where they do, and for cameras that are not turned.
  std::string HeadingNote(const SceneState& state) const;

  /// "front"; of fixed places and paths: "" and the file's name.
  std::string name() const;

 private:
  // What the camera is aimed at, scene after scene.
  struct Follower {
    render::SmoothedGroundExtent steady;
    render::GroundExtent followed;  // where the lagging camera is
    bool has_met = false;           // a person to follow
    Eigen::Vector3d first_middle = Eigen::Vector3d::Zero();
    double at_secs = 0;

    const render::GroundExtent& Follow(const SceneState& state, double secs,
                                       std::optional<double> lag_secs);
  };

  Eigen::AlignedBox3d Extent(const SceneState& state) const;
  bool IsNamed() const { return !place_ && keys_.empty(); }
  render::Camera NamedAt(const std::string& name, const render::GroundExtent& ground) const;
  render::Camera OnBase(render::Camera camera, const SceneState& state) const;
  render::Camera Placed(const SceneState& state, const render::GroundExtent& ground,
                        double secs) const;
  render::Camera Finished(const render::Camera& placed, const render::GroundExtent& ground,
                          const SceneState& state, double secs, double aspect,
                          const std::vector<Ball>& beside) const;
  render::Camera ForClip(const render::Camera& camera, const render::GroundExtent& ground,
                         double aspect) const;
  render::Camera AimAt(const render::GroundExtent& ground, const SceneState& state, double secs,
                       double aspect, const std::vector<Ball>& beside) const;
  double SecsOf(const SceneState& state);
  bool HoldsView(const SceneState& state) const;
  render::Camera Lensed(render::Camera camera, double secs) const;
  render::ViewPlace HeldPlace(bool has_people, const render::ViewHull& needed,
                              const render::Camera& camera, const render::ViewShape& shape,
                              double secs);
  render::Camera AimHeld(const SceneState& state, double secs, const render::ViewShape& live,
                         const std::optional<render::ViewShape>& shape);
  void FollowHeading(const SceneState& state, double secs);
  double LiveHeading(const SceneState& state) const;
  render::Camera Alone(const SceneState& state, double secs, double aspect,
                       const std::vector<Ball>& beside) const;

  std::string camera_;
  std::optional<render::Camera> place_;
  std::vector<CameraKeySpec> keys_;
  bool is_orthographic_ = false, is_one_turn_ = false;
  std::optional<double> fov_rad_, follow_secs_;
  double orbit_rad_per_sec_ = 0;
  Fit fit_ = Fit::kOff;
  bool holds_view_ = false;  // of an automatic fit whose future is not known
  render::FreeArea free_area_;
  CameraFrame frame_ = CameraFrame::kStart;
  CameraBase base_;
  // Of the prescan:
  Follower prescan_follower_;
  render::BallHull clip_, clip_around_people_;  // world; relative to what the camera follows
  Eigen::AlignedBox3d clip_extent_;             // all that the clip shows without people
  std::optional<std::int64_t> prescan_start_nanos_;
  double clip_secs_ = 0, next_prescan_secs_ = 0;
  // Of the pictures so far:
  std::optional<std::int64_t> start_nanos_;
  Follower follower_;
  render::HeldGroundExtent held_;
  render::HeldView held_view_;
  std::optional<double> heading_rad_;  // by which named cameras are turned
  double heading_at_secs_ = 0;
};

}  // namespace kinescope::app
