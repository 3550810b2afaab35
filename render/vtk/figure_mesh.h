/// The visuals of a person's URDF as one mesh with a part for each of the 23 segments.
#pragma once

#include <string>
#include <vector>

#include "render/vtk/mesh.h"
#include "server/core/scene_state.h"

namespace kinescope::render {

struct FigureMesh {
  struct Placeholder {
    int segment = 0;
    Eigen::Vector3d center_in_link = Eigen::Vector3d::Zero();
    std::string label;  // the file that is missing
  };
  Mesh mesh;                              // positions in link frames; part = urdf::Segment
  bool is_closed = true;                  // no surface that could be seen from within
  std::vector<Placeholder> placeholders;  // drawn as boxes
  std::vector<std::string> problems;      // one line for each mesh that could not be read
};

/// Links other than the 23 of the human are left out. Visuals without a colour get kBodyColor.
FigureMesh MakeFigureMesh(const PersonModel& model);

}  // namespace kinescope::render
