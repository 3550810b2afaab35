/// Renders the soft shadow that a body casts on the floor: where its limbs cover the sky. It tells
/// the eye where feet, hands and knees touch the floor.
#pragma once

#include <vtkFloatArray.h>
#include <vtkNew.h>

#include <vector>

#include "core/palette.h"
#include "render/vtk/shaded_actor.h"
#include "urdf/skin/occlusion.h"

namespace kinescope::render {

class FloorShadow {
 public:
  FloorShadow();

  void Cast(const skin::Capsules& limbs, const Rgb& color);
  vtkActor* actor() { return shaded_.actor(); }

 private:
  ShadedActor shaded_;
  std::vector<Eigen::Vector3f> points_;  // of a grid around the person
  std::vector<float> open_;
  vtkNew<vtkFloatArray> positions_, shade_;
};

}  // namespace kinescope::render
