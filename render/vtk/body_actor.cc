#include "render/vtk/body_actor.h"

#include <vtkActor.h>

#include <algorithm>

#include "core/person_links.h"
#include "render/shape/coarser_mesh.h"

namespace kinescope::render {
namespace {

constexpr std::size_t kMostTriangles = 200'000;  // of a mesh that is worth the time to make them

}  // namespace

void BodyActor::AddActor(double error_m, Group& group) const {
  // A surface that is seen from its back is lit from there, pixel by pixel.
  const bool is_small = error_m > 0 && group.mesh.is_closed;
  const auto light = is_small ? PartActor::Light::kLitAtVertices : PartActor::Light::kLit;
  auto actor = std::make_unique<PartActor>(pass_, light, static_cast<int>(group.count));
  actor->SetMesh(error_m > 0 ? CoarserMesh(group.mesh.mesh, error_m) : group.mesh.mesh);
  actor->SetCulling(group.mesh.is_closed);
  group.actors[error_m] = std::move(actor);
  if (group.is_fixed) group.mesh.mesh = urdf::Mesh();
}

void BodyActor::Load(const PersonModel& model, bool is_skin, OnceLog& log) {
  groups_.clear();
  problems_.clear();
  VisualReader reader(model.mesh_files, urdf::ShapeDetail::Body());
  const std::vector<std::string> names = VisibleLinks(model.human);
  for (std::size_t first = 0; first < names.size(); first += PartActor::kMaxParts) {
    Group group;
    group.first = first;
    group.count = std::min(PartActor::kMaxParts, names.size() - first);
    for (std::size_t part = 0; part < group.count; ++part) {
      const auto& links = model.robot.links;
      const auto link = std::find_if(links.begin(), links.end(), [&](const urdf::Link& each) {
        return each.name == names[first + part];
      });
      if (link == links.end()) continue;
      for (const urdf::Visual& visual : link->visuals) {
        if (is_skin && IsOfBody(model.human, first + part, visual)) continue;
        reader.Add(visual, static_cast<int>(part), group.mesh);
      }
    }
    group.is_fixed = group.mesh.mesh.triangles.size() / 3 > kMostTriangles;
    const std::vector<std::string>& problems = group.mesh.problems;
    problems_.insert(problems_.end(), problems.begin(), problems.end());
    groups_.push_back(std::move(group));
  }
  for (const std::string& problem : problems_) log(problem);
}

void BodyActor::Show(PartActor& actor, const Group& group, const std::vector<urdf::Pose>& poses,
                     const Eigen::Vector4f& override_color) {
  for (std::size_t part = 0; part < group.count; ++part) {
    const urdf::Pose& pose = poses[group.first + part];
    actor.Place(static_cast<int>(part), Eigen::Translation3d(pose.position) * pose.orientation);
  }
  actor.SetOverride(override_color);
  actor.SetOpacity(static_cast<float>(opacity_));
  actor.Commit();
}

bool BodyActor::Update(const PersonState& person, const Look& look,
                       const Eigen::Vector4f& override_color, const Error& error, OnceLog& log,
                       std::vector<Label>& labels) {
  const bool is_skin = look.figure.kind == Figure::kSkin && person.model->has_built_in_surface;
  const bool is_new =
      model_ != person.model || revision_ != person.model->revision || is_skin_ != is_skin;
  bool is_changed = is_new;
  if (is_new) {
    Load(*person.model, is_skin, log);
    is_skin_ = is_skin;
    model_ = person.model;
    revision_ = person.model->revision;
  }
  skin_.SetVisible(is_visible_ && is_skin);
  if (is_skin) {
    const bool is_other = skin_.Update(
        person, look.figure.own_skin, override_color, opacity_, error.skin,
        {error.is_far && !look.is_flat, look.has_loads, look.is_flat, !look.figure.own_skin});
    is_changed = is_changed || is_other;
  }
  const std::vector<urdf::Pose> poses = VisibleLinkPoses(person);
  for (Group& group : groups_) {
    const double shown =
        group.is_fixed ? 0 : PermittedError({0.001, 0.002, 0.004, 0.006, 0.010}, error.parts);
    if (group.actors.count(shown) == 0) {
      AddActor(shown, group);
      is_changed = true;
    }
    for (const auto& [of, actor] : group.actors) {
      actor->actor()->SetVisibility(is_visible_ && of == shown);
    }
    Show(*group.actors[shown], group, poses, override_color);
    for (const VisualMesh::Placeholder& placeholder : group.mesh.placeholders) {
      const urdf::Pose& pose = poses[group.first + static_cast<std::size_t>(placeholder.part)];
      labels.push_back({pose.position + pose.orientation * placeholder.center_in_link,
                        placeholder.label, Label::Kind::kFault});
    }
  }
  return is_changed;
}

void BodyActor::AddTo(PictureRegion& region) const {
  if (is_skin_) skin_.AddTo(region);
  for (const Group& group : groups_) {
    for (const auto& [error, actor] : group.actors) actor->AddTo(region);
  }
}

std::vector<vtkActor*> BodyActor::actors() {
  std::vector<vtkActor*> actors;
  if (is_skin_) actors = skin_.actors();
  for (Group& group : groups_) {
    for (const auto& [error, actor] : group.actors) actors.push_back(actor->actor());
  }
  return actors;
}

}  // namespace kinescope::render
