/// Renders the ground reaction force on each foot as an arrow from its centre of pressure: 1 m for
/// 1000 N (kMetresPerNewton). An unknown force has no arrow.
#pragma once

#include <string>
#include <vector>

#include "core/scene_state.h"
#include "render/camera/picture_region.h"
#include "render/module.h"
#include "render/vtk/part_actor.h"

namespace kinescope::render {

class ForceArrows {
 public:
  ForceArrows();
  /// With `labels`: adds the force of each arrow in N.
  void Show(const PersonState& person, std::vector<Label>* labels);

  /// By part of solid() and ghost(): "force on the right foot".
  static std::vector<std::string> Names();

  vtkActor* solid() { return solid_.actor(); }
  /// The ghost is where the solid is.
  void AddTo(PictureRegion& region) const { solid_.AddTo(region); }
  vtkActor* ghost() { return ghost_.actor(); }  // where another element is in front of it

 private:
  PartActor solid_, ghost_;
};

}  // namespace kinescope::render
