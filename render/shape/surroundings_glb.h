/// Writes external markers and robots as a GLB (render/surroundings.h). One thread.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "render/shape/marker_shapes.h"
#include "render/surroundings.h"

namespace kinescope::render {

class SurroundingsGlb : public SurroundingsWriter {
 public:
  /// A page in a browser draws as many at once.
  static constexpr std::size_t kMaxTriangles = 400'000;  // of markers

  SurroundingsGlb() : markers_(kMaxTriangles) {}
  std::string Write(const std::vector<std::shared_ptr<const SceneMarker>>& markers,
                    const std::vector<RobotState>& robots) override;

 private:
  /// A surface in the frames of links; part: number of the link.
  struct Surface {
    VisualMesh solid, blended;
  };
  struct RobotShape {
    std::shared_ptr<const urdf::RobotModel> model;  // held, so that its address is not reused
    /// Of a robot that stands: one. Of one that moves: one for each of LinksToDraw().
    std::vector<Surface> surfaces;
  };
  const RobotShape& ShapeOf(const RobotState& robot);

  MarkerReader markers_;
  std::map<const urdf::RobotModel*, RobotShape> robots_;
};

}  // namespace kinescope::render
