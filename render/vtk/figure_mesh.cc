#include "render/vtk/figure_mesh.h"

#include <algorithm>
#include <stdexcept>

#include "render/vtk/mesh_file.h"
#include "server/core/palette.h"
#include "urdf/human_urdf.h"

namespace kinescope::render {
namespace {

constexpr double kPlaceholderSide = 0.12;  // m

std::string FileName(const std::string& uri) {
  const std::size_t slash = uri.find_last_of('/');
  return slash == std::string::npos ? uri : uri.substr(slash + 1);
}

void AddVisual(const urdf::Visual& visual, int segment, FigureMesh& figure) {
  const std::size_t first = figure.mesh.positions.size();
  const urdf::Geometry& shape = visual.geometry;
  const Eigen::Affine3d place(visual.link_from_visual.matrix());
  Eigen::Vector4f color(static_cast<float>(kBodyColor[0]), static_cast<float>(kBodyColor[1]),
                        static_cast<float>(kBodyColor[2]), 1);
  if (visual.rgba) color = visual.rgba->cast<float>();
  switch (shape.kind) {
    case urdf::Geometry::Kind::kBox: figure.mesh.Append(BoxMesh(shape.size), place); break;
    case urdf::Geometry::Kind::kCylinder:
      figure.mesh.Append(CylinderMesh(shape.size.x(), shape.size.y()), place);
      break;
    case urdf::Geometry::Kind::kSphere:
      figure.mesh.Append(SphereMesh(shape.size.x()), place);
      break;
    case urdf::Geometry::Kind::kMesh:
      try {
        const Mesh mesh = ReadMeshFile(shape.mesh_uri);
        figure.is_closed = figure.is_closed && mesh.IsClosed();
        figure.mesh.Append(mesh, place * Eigen::Scaling(shape.size));
      } catch (const std::runtime_error& error) {
        figure.problems.push_back(error.what());
        figure.placeholders.push_back(
            {segment, place.translation(), "missing: " + FileName(shape.mesh_uri)});
        figure.mesh.Append(BoxMesh(Eigen::Vector3d::Constant(kPlaceholderSide)), place);
        color = {0.85f, 0.62f, 0.80f, 1};  // no colour that the palette uses
      }
      break;
  }
  figure.mesh.Paint(first, color, segment);
}

}  // namespace

FigureMesh MakeFigureMesh(const PersonModel& model) {
  FigureMesh figure;
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    const std::string name = urdf::LinkName(model.human.model_name, segment);
    const auto link = std::find_if(model.robot.links.begin(), model.robot.links.end(),
                                   [&](const urdf::Link& each) { return each.name == name; });
    if (link == model.robot.links.end()) continue;
    for (const urdf::Visual& visual : link->visuals) AddVisual(visual, segment, figure);
  }
  return figure;
}

}  // namespace kinescope::render
