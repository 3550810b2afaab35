/// The floor at z = 0: a grid of 1 m and 0.25 m that fades into the background.
#pragma once

#include <Eigen/Core>

#include "render/scene_look.h"
#include "render/vtk/shaded_actor.h"

namespace kinescope::render {

class Ground {
 public:
  Ground();
  /// Where the floor is clearest, world.
  void SetFocus(const Eigen::Vector3d& focus);
  void SetLook(const SceneLook& look);
  vtkActor* actor() { return shaded_.actor(); }

 private:
  ShadedActor shaded_;
};

}  // namespace kinescope::render
