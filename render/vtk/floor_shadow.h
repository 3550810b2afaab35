/// Renders the soft shadow that a body casts on the floor: where its limbs cover the sky. It tells
/// the eye where feet, hands and knees touch the floor.
#pragma once

#include <vtkFloatArray.h>
#include <vtkNew.h>

#include <cstdint>
#include <vector>

#include "core/palette.h"
#include "render/camera/picture_region.h"
#include "render/vtk/shaded_actor.h"
#include "urdf/skin/occlusion.h"

namespace kinescope::render {

class FloorShadow {
 public:
  FloorShadow();

  void Cast(const skin::Capsules& limbs, const Rgb& color);
  vtkActor* actor() { return shaded_.actor(); }
  /// Of the newest Cast, if it is visible.
  void AddTo(PictureRegion& region) const;

 private:
  ShadedActor shaded_;
  std::vector<Eigen::Vector3f> points_;  // of a grid around the person
  std::vector<float> open_;
  std::vector<std::uint32_t> shown_;  // triangles of the grid
  vtkNew<vtkFloatArray> positions_, shade_;
};

}  // namespace kinescope::render
