/// Which way the named cameras of live pictures and of the page are turned. It is computed once,
/// for all of them, and is part of each state. One thread.
#pragma once

#include <cstdint>
#include <optional>

#include "core/scene_state.h"

namespace kinescope::app {

/// What named cameras are turned with: "front" sees the person's face, or looks along the world's x
/// axis.
enum class CameraFrame {
  kStart,   // the person's heading at the beginning
  kPerson,  // the person's heading now
  kWorld,
};

/// A heading (rad, about z) that is nearly along the floor's lines is meant to be along them: a
/// walking pelvis turns by that much.
double AlongFloorLines(double heading_rad);

/// - kStart: the heading of the person when they first stood or sat upright. Until then, that of
/// the
///   first sample. It is taken again where the motion is not continued: after a jump, a restart of
///   the sender's counter or 10 s without a sample.
/// - kPerson: stands still while the person turns to and fro, and then turns slowly. It waits while
///   they spin.
/// Where a heading is undefined, the last one is kept. A turn is a glide, but for a jump.
class HeldHeading {
 public:
  explicit HeldHeading(CameraFrame frame) : frame_(frame) {}

  /// Call it for every sample of the person; the same one again changes nothing.
  /// @return rad, from the world's x axis about z
  double Follow(const PersonState& person);

 private:
  bool IsContinued(const PersonState& person, double dt) const;
  void Begin(std::optional<double> now);
  void FollowStart(const urdf::LinkPoses& links, std::optional<double> now);
  void FollowPerson(std::optional<double> now, double dt);
  void Glide(double dt);

  const CameraFrame frame_;
  // Of the newest sample:
  std::optional<int> character_;
  std::int64_t stamp_nanos_ = 0;
  std::uint32_t counter_ = 0;
  urdf::Pose pelvis_;
  // Of what is shown:
  double shown_ = 0, speed_ = 0, goal_ = 0;  // rad, rad/s
  bool has_stood_ = false;                   // kStart
  bool is_gliding_ = false;
  Eigen::Vector2d mean_ = Eigen::Vector2d::Zero();  // kPerson: direction over the last second;
                                                    // short for a person who spins
};

}  // namespace kinescope::app
