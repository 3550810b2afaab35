/// Draws points as squares that face the camera, in one draw call: as large as they are in the
/// world, or of so many pixels of the picture at any distance. Their colours are not lit, so that
/// they mean what a legend or another program says they mean.
#pragma once

#include <string>
#include <vector>

#include "render/shape/marker_shapes.h"
#include "render/vtk/shaded_actor.h"

namespace kinescope::render {

class PointActor {
 public:
  /// Draws those that are blended, or the others.
  explicit PointActor(bool is_blended);

  /// The size of what is drawn into the whole viewport, a picture or a tile of it: pixels of the
  /// picture, which are larger than those drawn if it is supersampled. Call it before each drawing.
  void SetViewSize(int width_px, int height_px);
  /// Uploads them; invisible without any. The parts of the actor are the numbers of the markers.
  void SetPoints(const std::vector<MarkerPoints>& all);
  vtkActor* actor() { return shaded_.actor(); }
  /// By part: "scan/0".
  const std::vector<std::string>& names() const { return names_; }

 private:
  const bool is_blended_;
  ShadedActor shaded_;
  std::vector<std::string> names_;
};

}  // namespace kinescope::render
