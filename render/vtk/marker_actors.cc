#include "render/vtk/marker_actors.h"

#include <vtkActor.h>

#include <utility>

namespace kinescope::render {
namespace {

constexpr std::size_t kMaxMarkerTriangles = 2'000'000;  // of all markers together

}  // namespace

MarkerActors::MarkerActors() : reader_(kMaxMarkerTriangles) {
  for (Surface* surface : Surfaces()) {
    surface->actor.Place(0, Eigen::Affine3d::Identity());
    surface->actor.Commit();
    surface->actor.actor()->SetVisibility(false);
  }
}

void MarkerActors::Show(MarkerSurface& shape, Surface& surface) {
  surface.names = std::move(shape.names);
  surface.actor.actor()->SetVisibility(!shape.mesh.triangles.empty());
  if (!shape.mesh.triangles.empty()) surface.actor.SetMesh(shape.mesh);
}

void MarkerActors::Build() {
  MarkerShapes shapes = reader_.Read(markers_);
  Show(shapes.ground_depth, ground_depth_);
  Show(shapes.ground, ground_);
  Show(shapes.solid, solid_);
  Show(shapes.blended, blended_);
  solid_.actor.SetCulling(shapes.is_closed);
  for (PointActor* points : {&solid_points_, &blended_points_}) points->SetPoints(shapes.points);
  for (LineActor* lines : {&solid_lines_, &blended_lines_}) lines->SetLines(shapes.lines);
  boxes_ = std::move(shapes.boxes);
  labels_ = std::move(shapes.labels);
  problems_ = std::move(shapes.problems);
}

void MarkerActors::Update(const std::vector<std::shared_ptr<const SceneMarker>>& markers,
                          OnceLog& log, std::vector<Label>& labels) {
  if (markers != markers_) {
    markers_ = markers;
    Build();
    for (const std::string& problem : problems_) log(problem);
  }
  labels.insert(labels.end(), labels_.begin(), labels_.end());
}

void MarkerActors::SetViewSize(int width_px, int height_px) {
  for (UnlitActor* unlit : Unlit()) unlit->SetViewSize(width_px, height_px);
}

std::vector<std::string> MarkerActors::NamesOf(const vtkActor* actor) {
  std::vector<std::string> names;
  for (Surface* surface : Surfaces()) {
    if (actor == surface->actor.actor()) names = surface->names;
  }
  for (UnlitActor* unlit : Unlit()) {
    if (actor == unlit->actor()) names = unlit->names();
  }
  for (std::string& name : names) name.insert(0, "marker ");
  return names;
}

void MarkerActors::AddTo(PictureRegion& region) const {
  for (const auto& [box, around_px] : boxes_) {
    region.AddBox(box, Eigen::Matrix4f::Identity(), around_px);
  }
}

}  // namespace kinescope::render
