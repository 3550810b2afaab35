#include "render/vtk/figure_mesh.h"

#include <algorithm>

#include "urdf/human_urdf.h"

namespace kinescope::render {

VisualMesh MakeFigureMesh(const PersonModel& model) {
  VisualMesh figure;
  VisualReader reader(urdf::MeshSearch(), ShapeDetail::Figure());
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    const std::string name = urdf::LinkName(model.human.model_name, segment);
    const auto link = std::find_if(model.robot.links.begin(), model.robot.links.end(),
                                   [&](const urdf::Link& each) { return each.name == name; });
    if (link == model.robot.links.end()) continue;
    for (const urdf::Visual& visual : link->visuals) reader.Add(visual, segment, figure);
  }
  return figure;
}

}  // namespace kinescope::render
