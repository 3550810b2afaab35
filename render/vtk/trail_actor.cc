#include "render/vtk/trail_actor.h"

#include <vtkActor.h>

#include "render/shape/line_mesh.h"

namespace kinescope::render {
namespace {

constexpr double kOldRadius = 0.0015, kNewRadius = 0.007;  // m
constexpr int kSides = 8;

}  // namespace

void TrailActor::Show(const std::vector<Trail>& trails) {
  mesh_ = urdf::Mesh();
  names_.clear();
  for (const Trail& trail : trails) {
    const Eigen::Vector4f color(static_cast<float>(trail.color[0]),
                                static_cast<float>(trail.color[1]),
                                static_cast<float>(trail.color[2]), 1);
    std::vector<TubePoint> points;
    for (std::size_t i = 0; i < trail.points.size(); ++i) {
      if (!trail.points[i].allFinite()) continue;
      const double share = (static_cast<double>(i) + 1) / static_cast<double>(trail.points.size());
      points.push_back({trail.points[i], kOldRadius + share * (kNewRadius - kOldRadius), color});
    }
    AppendTube(points, kSides, static_cast<int>(names_.size()), mesh_);
    names_.push_back(trail.name.empty() ? "trail" : "trail of " + trail.name);
  }
  part_.actor()->SetVisibility(!mesh_.triangles.empty());
  if (mesh_.triangles.empty()) return;
  part_.SetMesh(mesh_);
  part_.Place(0, Eigen::Affine3d::Identity());
  part_.Commit();
}

void TrailActor::AddTo(PictureRegion& region) const {
  region.AddTriangles(mesh_.positions, mesh_.triangles);
}

}  // namespace kinescope::render
