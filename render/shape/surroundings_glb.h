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
  /// A robot's surface, in the frames of its links.
  struct RobotShape {
    std::shared_ptr<const urdf::RobotModel> model;  // held, so that its address is not reused
    VisualMesh solid, blended;                      // part: number of the link
  };
  const RobotShape& ShapeOf(const RobotState& robot);

  MarkerReader markers_;
  std::map<const urdf::RobotModel*, RobotShape> robots_;
};

}  // namespace kinescope::render
