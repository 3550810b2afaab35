/// Draws lines that are so many pixels of the picture wide at any distance, in one draw call. Their
/// colours are not lit, as those of PointActor are not.
#pragma once

#include <string>
#include <vector>

#include "render/shape/marker_shapes.h"
#include "render/vtk/shaded_actor.h"

namespace kinescope::render {

class LineActor {
 public:
  /// Draws those that are blended, or the others.
  explicit LineActor(bool is_blended);

  /// As that of PointActor.
  void SetViewSize(int width_px, int height_px);
  /// Uploads them; invisible without any. The parts of the actor are the numbers of the markers.
  void SetLines(const std::vector<MarkerLines>& all);
  vtkActor* actor() { return shaded_.actor(); }
  /// By part: "rviz/Grid/0".
  const std::vector<std::string>& names() const { return names_; }

 private:
  const bool is_blended_;
  ShadedActor shaded_;
  std::vector<std::string> names_;
};

}  // namespace kinescope::render
