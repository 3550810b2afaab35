/// Draws lines that are a pixel of the picture wide at any distance.
#pragma once

#include <vector>

#include "render/shape/marker_shapes.h"
#include "render/vtk/unlit_actor.h"

namespace kinescope::render {

class LineActor : public UnlitActor {
 public:
  explicit LineActor(bool is_blended);

  /// Uploads them; invisible without any.
  void SetLines(const std::vector<MarkerLines>& all);
};

}  // namespace kinescope::render
