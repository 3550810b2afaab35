/// The floor at z = 0: a grid of 1 m and 0.25 m that fades into the background.
#pragma once

#include <Eigen/Core>

#include "render/vtk/shaded_actor.h"
#include "server/core/palette.h"

namespace kinescope::render {

inline constexpr Rgb kBackground = {0.955, 0.962, 0.972};

class Ground {
 public:
  Ground();
  /// Where the floor is clearest, world.
  void SetFocus(const Eigen::Vector3d& focus);
  vtkActor* actor() { return shaded_.actor(); }

 private:
  ShadedActor shaded_;
};

}  // namespace kinescope::render
