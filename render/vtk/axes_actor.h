/// Renders axes at every link of a person: the link frames, or the joint axes. x red, y green, z
/// blue, visible through the body.
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
    kFrames,  // frames of the links, as in TF: from the origin along each positive axis
    kJoints,  // y fixed in the parent, x between, z fixed in the child (urdf/kinematics.h)
  };
  explicit AxesActor(Kind kind);

  void Show(const PersonState& person);
  std::vector<vtkActor*> solids();
  std::vector<vtkActor*> ghosts();
  void AddTo(PictureRegion& region) const;

 private:
  const Kind kind_;
  std::array<std::unique_ptr<PartActor>, 3> solid_, ghost_;  // by axis; parts by segment
};

}  // namespace kinescope::render
