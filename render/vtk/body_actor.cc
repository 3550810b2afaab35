#include "render/vtk/body_actor.h"

#include <vtkActor.h>

#include <algorithm>

#include "core/person_links.h"

namespace kinescope::render {
void BodyActor::Load(const PersonModel& model, OnceLog& log) {
  groups_.clear();
  problems_.clear();
  if (model.mesh_files) model.mesh_files->Provide();  // what is missing is reported below
  VisualReader reader(urdf::MeshSearch(), urdf::ShapeDetail::Body());
  const std::vector<std::string> names = VisibleLinks(model.human);
  for (std::size_t first = 0; first < names.size(); first += PartActor::kMaxParts) {
    Group group;
    group.first = first;
    group.count = std::min(PartActor::kMaxParts, names.size() - first);
    VisualMesh mesh;
    for (std::size_t part = 0; part < group.count; ++part) {
      const auto& links = model.robot.links;
      const auto link = std::find_if(links.begin(), links.end(), [&](const urdf::Link& each) {
        return each.name == names[first + part];
      });
      if (link == links.end()) continue;
      for (const urdf::Visual& visual : link->visuals) {
        reader.Add(visual, static_cast<int>(part), mesh);
      }
    }
    group.actor =
        std::make_unique<PartActor>(pass_, PartActor::Light::kLit, static_cast<int>(group.count));
    group.actor->SetMesh(mesh.mesh);
    group.actor->SetCulling(mesh.is_closed);
    group.placeholders = std::move(mesh.placeholders);
    problems_.insert(problems_.end(), mesh.problems.begin(), mesh.problems.end());
    groups_.push_back(std::move(group));
  }
  for (const std::string& problem : problems_) log(problem);
}

bool BodyActor::Update(const PersonState& person, const Eigen::Vector4f& override_color,
                       OnceLog& log, std::vector<Label>& labels) {
  const bool is_new = model_ != person.model || revision_ != person.model->revision;
  if (is_new) {
    Load(*person.model, log);
    model_ = person.model;
    revision_ = person.model->revision;
  }
  const std::vector<urdf::Pose> poses = VisibleLinkPoses(person);
  for (Group& group : groups_) {
    for (std::size_t part = 0; part < group.count; ++part) {
      const urdf::Pose& pose = poses[group.first + part];
      group.actor->Place(static_cast<int>(part),
                         Eigen::Translation3d(pose.position) * pose.orientation);
    }
    group.actor->SetOverride(override_color);
    group.actor->SetOpacity(static_cast<float>(opacity_));
    group.actor->Commit();
    for (const VisualMesh::Placeholder& placeholder : group.placeholders) {
      const urdf::Pose& pose = poses[group.first + static_cast<std::size_t>(placeholder.part)];
      labels.push_back({pose.position + pose.orientation * placeholder.center_in_link,
                        placeholder.label, Label::Kind::kFault});
    }
  }
  return is_new;
}

void BodyActor::SetVisible(bool is_visible) {
  for (Group& group : groups_) group.actor->actor()->SetVisibility(is_visible);
}

std::vector<vtkActor*> BodyActor::actors() {
  std::vector<vtkActor*> actors;
  for (Group& group : groups_) actors.push_back(group.actor->actor());
  return actors;
}

}  // namespace kinescope::render
