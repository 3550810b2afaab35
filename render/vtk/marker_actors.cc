#include "render/vtk/marker_actors.h"

#include <vtkActor.h>

#include <algorithm>

#include "render/shape/marker_mesh.h"

namespace kinescope::render {
namespace {

constexpr std::size_t kMaxMarkerTriangles = 2'000'000;  // of all markers together
constexpr std::size_t kMaxMarkers = 10'000;
constexpr std::size_t kMaxMeshFiles = 64;  // kept
constexpr std::size_t kMaxProblems = 20;   // named; a flood of markers is one fault, not thousands

bool IsTranslucent(const SceneMarker& marker) {
  const auto is_clear = [](const Eigen::Vector4d& color) { return color.w() < 1; };
  return marker.colors.empty() ? is_clear(marker.color)
                               : std::any_of(marker.colors.begin(), marker.colors.end(), is_clear);
}

}  // namespace

MarkerActors::MarkerActors()
    : solid_(Pass::kSolid, PartActor::Light::kLit, 1),
      blended_(Pass::kBlended, PartActor::Light::kLit, 1) {
  for (PartActor* actor : {&solid_, &blended_}) {
    actor->Place(0, Eigen::Affine3d::Identity());
    actor->Commit();
    actor->actor()->SetVisibility(false);
  }
}

const VisualMesh& MarkerActors::MeshOf(const std::string& uri) {
  const auto known = meshes_.find(uri);
  if (known != meshes_.end()) return known->second;
  if (meshes_.size() >= kMaxMeshFiles) meshes_.clear();
  urdf::Visual visual;
  visual.geometry = {urdf::Geometry::Kind::kMesh, Eigen::Vector3d::Ones(), uri};
  visual.rgba = Eigen::Vector4d::Zero();  // stays where the file has no colour
  VisualReader reader(urdf::MakeMeshSearch({}, {}), urdf::ShapeDetail::Robot());
  VisualMesh& mesh = meshes_[uri];
  reader.Add(visual, 0, mesh);
  return mesh;
}

void MarkerActors::AddMesh(const SceneMarker& marker, urdf::Mesh& to) {
  const VisualMesh& mesh = MeshOf(marker.mesh_uri);
  for (const std::string& problem : mesh.problems) {
    problems_.push_back("marker " + IdentityOf(marker) + ": " + problem);
  }
  Eigen::Affine3d place(Eigen::Translation3d(marker.pose.position) * marker.pose.orientation);
  if (mesh.placeholders.empty()) {
    place.scale(marker.scale);
  } else {
    labels_.push_back({marker.pose.position, mesh.placeholders.front().label, Label::Kind::kFault});
  }
  const std::size_t count = mesh.mesh.triangles.size() / 3;
  if (triangles_ + count > kMaxMarkerTriangles) {
    problems_.push_back("marker " + IdentityOf(marker) +
                        ": all markers together have too many triangles");
    return;
  }
  triangles_ += count;
  is_closed_ = is_closed_ && mesh.is_closed;
  const std::size_t first = to.positions.size();
  to.Append(mesh.mesh, place);
  const Eigen::Vector4f color = marker.color.cast<float>();
  if (mesh.placeholders.empty()) to.Paint(first, color, 0);
  if (!marker.mesh_has_own_colors || !mesh.placeholders.empty()) return;
  for (std::size_t i = 0; i < mesh.mesh.colors.size(); ++i) {
    if (mesh.mesh.colors[i].w() > 0) to.colors[first + i] = mesh.mesh.colors[i];
  }
}

void MarkerActors::Build() {
  problems_.clear();
  labels_.clear();
  boxes_.clear();
  triangles_ = 0;
  is_closed_ = true;
  urdf::Mesh solid, blended;
  std::size_t count = 0;
  for (const auto& marker : markers_) {
    const auto refuse = [&](const std::string& why) {
      problems_.push_back("marker " + IdentityOf(*marker) + " is not drawn: " + why);
    };
    if (++count > kMaxMarkers) {
      refuse("there are " + std::to_string(markers_.size()) + " markers, more than " +
             std::to_string(kMaxMarkers));
      break;
    }
    if (const auto defect = FindDefect(*marker)) {
      refuse(*defect);
      continue;
    }
    if (marker->type == MarkerType::kText) {
      const Eigen::Vector4d& c = marker->color;
      labels_.push_back({marker->pose.position,
                         marker->text,
                         Label::Kind::kMarker,
                         marker->scale.z(),
                         {c.x(), c.y(), c.z()},
                         c.w()});
      continue;
    }
    urdf::Mesh& to = IsTranslucent(*marker) ? blended : solid;
    const std::size_t first = to.positions.size();
    if (marker->type == MarkerType::kMesh) {
      AddMesh(*marker, to);
    } else if (const std::size_t more = TriangleCount(*marker);
               triangles_ + more > kMaxMarkerTriangles) {
      refuse("all markers together have too many triangles");
    } else {
      triangles_ += more;
      AppendMarker(*marker, to);
    }
    Eigen::AlignedBox3f& box = boxes_.emplace_back();
    for (std::size_t i = first; i < to.positions.size(); ++i) box.extend(to.positions[i]);
  }
  if (problems_.size() > kMaxProblems) {
    const std::size_t more = problems_.size() - kMaxProblems;
    problems_.resize(kMaxProblems);
    problems_.push_back("and " + std::to_string(more) + " more markers");
  }
  solid_.actor()->SetVisibility(!solid.triangles.empty());
  blended_.actor()->SetVisibility(!blended.triangles.empty());
  if (!solid.triangles.empty()) solid_.SetMesh(solid);
  if (!blended.triangles.empty()) blended_.SetMesh(blended);
  solid_.SetCulling(is_closed_);
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

void MarkerActors::AddTo(PictureRegion& region) const {
  for (const Eigen::AlignedBox3f& box : boxes_) region.AddBox(box);
}

}  // namespace kinescope::render
