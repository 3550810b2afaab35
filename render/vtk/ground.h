/// Renders the floor at z = 0: a grid of 1 m and 0.25 m that fades into the background.
#pragma once

#include <Eigen/Core>
#include <array>

#include "render/scene_look.h"
#include "render/vtk/shaded_actor.h"

namespace kinescope::render {

class Ground {
 public:
  Ground();
  /// Point where the floor is most visible, world, m.
  void SetFocus(const Eigen::Vector3d& focus);
  /// Shows the floor of the theme, or none.
  void SetLook(const SceneLook& look);
  std::array<vtkActor*, 2> actors();

 private:
  void SetUniform(const char* name, const Eigen::Vector3d& value);

  struct Floor {
    explicit Floor(Theme theme_of);
    Theme theme;
    ShadedActor actor;
  };
  std::array<Floor, 2> floors_;
};

}  // namespace kinescope::render
