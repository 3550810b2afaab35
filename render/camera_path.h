/// A camera that moves from key to key. Times in seconds of the clip. Pure functions; any thread.
#pragma once

#include <vector>

#include "render/camera.h"

namespace kinescope::render {

/// How the way from one key to the next is gone: from rest to rest, evenly, or not at all until the
/// next one's time (a cut).
enum class Ease { kSmooth, kLinear, kHold };

struct CameraKey {
  double secs = 0;
  Camera camera;
  Ease ease = Ease::kSmooth;  // of the way to the next key
};

/// Between two cameras, `t` in [0, 1]: the target goes straight, the camera around it at a distance
/// that grows evenly, so that nobody in the middle is walked through. From perspective to
/// orthographic it cuts at the end.
Camera Between(const Camera& from, const Camera& to, double t);

/// Before the first key and after the last one it stands still.
/// @pre !keys.empty(), times ascend
Camera AlongPath(const std::vector<CameraKey>& keys, double secs);

}  // namespace kinescope::render
