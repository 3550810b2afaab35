#include "render/vtk/robot_actors.h"

#include <vtkActor.h>

#include <algorithm>

namespace kinescope::render {
namespace {

constexpr double kHighestShadow = 0.5;  // m above the floor

urdf::Mesh RobotShadow() {
  urdf::Mesh mesh;
  mesh.Append(urdf::DiscMesh(24), Eigen::Affine3d::Identity());
  mesh.Paint(0, {0.20f, 0.23f, 0.30f, 0.30f}, 0);
  return mesh;
}

}  // namespace

RobotActors::RobotActors() : shadow_(Pass::kBlended, PartActor::Light::kSoft, 1) {
  shadow_.SetMesh(RobotShadow());
}

std::vector<vtkActor*> RobotActors::bodies(bool are_translucent) {
  std::vector<vtkActor*> actors;
  for (Group& group : groups_) {
    if (group.is_translucent == are_translucent) actors.push_back(group.actor->actor());
  }
  return actors;
}

void RobotActors::AddGroup(VisualMesh mesh, std::vector<std::size_t> links, bool is_translucent) {
  for (std::string& problem : mesh.problems) problems_.push_back(std::move(problem));
  if (mesh.mesh.triangles.empty()) return;
  Group group;
  group.is_translucent = is_translucent;
  const auto pass = is_translucent ? Pass::kBlended : Pass::kSolid;
  group.actor =
      std::make_unique<PartActor>(pass, PartActor::Light::kLit, static_cast<int>(links.size()));
  group.actor->SetMesh(mesh.mesh);
  group.actor->SetCulling(mesh.is_closed);
  group.links = std::move(links);
  group.positions = std::move(mesh.mesh.positions);
  group.parts = std::move(mesh.mesh.parts);
  group.placeholders = std::move(mesh.placeholders);
  groups_.push_back(std::move(group));
}

void RobotActors::LoadGroups(const urdf::RobotModel& model, bool is_translucent,
                             VisualReader& reader) {
  VisualMesh mesh;
  std::vector<std::size_t> links;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    bool is_part = false;
    for (const urdf::Visual& visual : model.links[i].visuals) {
      const double opacity = OpacityOf(visual);
      if (opacity <= 0 || (opacity < 1) != is_translucent) continue;
      if (!is_part) links.push_back(i);
      is_part = true;
      reader.Add(visual, static_cast<int>(links.size()) - 1, mesh);
    }
    if (links.size() < PartActor::kMaxParts) continue;
    AddGroup(std::move(mesh), std::move(links), is_translucent);
    mesh = VisualMesh();
    links.clear();
  }
  if (!links.empty()) AddGroup(std::move(mesh), std::move(links), is_translucent);
}

void RobotActors::Load(const RobotState& robot, OnceLog& log) {
  groups_.clear();
  problems_.clear();
  VisualReader reader(robot.meshes ? *robot.meshes : urdf::MeshSearch(),
                      urdf::ShapeDetail::Robot());
  for (const bool is_translucent : {false, true}) LoadGroups(*robot.model, is_translucent, reader);
  std::sort(problems_.begin(), problems_.end());
  problems_.erase(std::unique(problems_.begin(), problems_.end()), problems_.end());
  for (const std::string& problem : problems_) log(problem);
  model_ = robot.model;
  meshes_ = robot.meshes;
}

bool RobotActors::Update(const RobotState& robot, const SceneLook& look, OnceLog& log,
                         std::vector<Label>& labels) {
  const bool is_new = !IsOf(robot);
  if (is_new) Load(robot, log);
  Eigen::AlignedBox3d around;
  for (Group& group : groups_) {
    for (std::size_t part = 0; part < group.links.size(); ++part) {
      const std::size_t link = group.links[part];
      const int index = static_cast<int>(part);
      if (link >= robot.world_from_link.size() || !CanBeDrawn(robot.world_from_link[link])) {
        group.actor->Hide(index);
        continue;
      }
      const Eigen::Isometry3d& pose = robot.world_from_link[link];
      group.actor->Place(index, Eigen::Affine3d(pose.matrix()));
      around.extend(group.actor->boxes()[part].cast<double>().transformed(pose));
    }
    group.actor->Commit();
    for (const VisualMesh::Placeholder& placeholder : group.placeholders) {
      const std::size_t link = group.links[static_cast<std::size_t>(placeholder.part)];
      if (link >= robot.world_from_link.size()) continue;
      labels.push_back({robot.world_from_link[link] * placeholder.center_in_link, placeholder.label,
                        Label::Kind::kFault});
    }
  }
  const Rgb& shadow = ColorsOf(look.theme).shadow;
  shadow_.SetOverride({static_cast<float>(shadow[0]), static_cast<float>(shadow[1]),
                       static_cast<float>(shadow[2]), 1});
  shadow_.actor()->SetVisibility(look.Shows(ScenePart::kShadows));
  UpdateShadow(around);
  return is_new;
}

Eigen::AlignedBox3d RobotActors::Measure(const RobotState& robot) const {
  Eigen::AlignedBox3d box;
  for (const Group& group : groups_) {
    for (std::size_t i = 0; i < group.positions.size(); ++i) {
      const std::size_t link = group.links[static_cast<std::size_t>(group.parts[i])];
      if (link >= robot.world_from_link.size()) continue;
      const Eigen::Isometry3d& pose = robot.world_from_link[link];
      if (CanBeDrawn(pose)) box.extend(pose * group.positions[i].cast<double>());
    }
  }
  return box;
}

// Not where a lamp would cast it, but what tells the eye where the robot stands.
void RobotActors::UpdateShadow(const Eigen::AlignedBox3d& around) {
  shadow_.Hide(0);
  if (!around.isEmpty() && around.min().z() < kHighestShadow) {
    const Eigen::Vector3d middle = around.center(), size = 0.6 * around.sizes();
    Eigen::Affine3d place = Eigen::Affine3d::Identity();
    place.translate(Eigen::Vector3d(middle.x(), middle.y(), 0.002));
    place.scale(Eigen::Vector3d(size.x() + 0.02, size.y() + 0.02, 1));
    shadow_.Place(0, place);
  }
  shadow_.Commit();
}

void RobotActors::AddTo(PictureRegion& region) const {
  shadow_.AddTo(region);
  for (const Group& group : groups_) group.actor->AddTo(region);
}

}  // namespace kinescope::render
