/// Draws points as squares that face the camera: as large as they are in the world, or of so many
/// pixels of the picture at any distance.
#pragma once

#include <vector>

#include "render/shape/marker_shapes.h"
#include "render/vtk/unlit_actor.h"

namespace kinescope::render {

class PointActor : public UnlitActor {
 public:
  explicit PointActor(bool is_blended);

  /// Uploads them; invisible without any.
  void SetPoints(const std::vector<MarkerPoints>& all);
};

}  // namespace kinescope::render
