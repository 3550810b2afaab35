/// Moves a camera from keyframe to keyframe. Times in seconds of the clip. World, metres. Pure
/// functions; any thread.
#pragma once

#include <vector>

#include "render/camera/camera.h"

namespace kinescope::render {

/// Motion from one keyframe to the next: from rest to rest, at constant speed, or none until the
/// time of the next one (a cut).
enum class Ease { kSmooth, kLinear, kHold };

struct CameraKey {
  double secs = 0;
  Camera camera;
  Ease ease = Ease::kSmooth;  // of the motion to the next keyframe
};

/// The camera between two others, `t` in [0, 1]. The target moves on a straight line, and the
/// distance of the camera to it changes evenly, so that the camera does not pass through a person
/// in the middle. Between perspective and orthographic it changes at the end.
Camera Between(const Camera& from, const Camera& to, double t);

/// Constant before the first and after the last keyframe.
/// @pre !keys.empty(), times ascend
Camera AlongPath(const std::vector<CameraKey>& keys, double secs);

}  // namespace kinescope::render
