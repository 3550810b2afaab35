/// Axes at every link of a person: the links' frames, or what the joints turn about. x red, y
/// green, z blue, seen through the body.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/scene_state.h"
#include "render/vtk/part_actor.h"

namespace kinescope::render {

class AxesActor {
 public:
  enum class Kind {
    kFrames,  // of links, as TF has them: from the origin along each positive axis
    kJoints,  // y fixed in the parent, x between, z fixed in the child (urdf/kinematics.h)
  };
  explicit AxesActor(Kind kind);

  void Show(const PersonState& person);
  std::vector<vtkActor*> solids();
  std::vector<vtkActor*> ghosts();

 private:
  const Kind kind_;
  std::array<std::unique_ptr<PartActor>, 3> solid_, ghost_;  // by axis; parts by segment
};

}  // namespace kinescope::render
