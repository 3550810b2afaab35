#include "render/vtk/object_actors.h"

#include <algorithm>

#include "core/palette.h"
#include "render/shape/line_mesh.h"

namespace kinescope::render {
namespace {

constexpr std::size_t kObjectsPerActor = 32;                              // PartActor's limit
constexpr double kAxisLength = 0.15, kAxisRadius = 0.005, kBlock = 0.05;  // m
constexpr double kLabelHeight = 0.10;                                     // m above the object

void AddObject(int part, urdf::Mesh& all) {
  const auto add = [&](const urdf::Mesh& mesh, const Eigen::Affine3d& place, const Rgb& rgb) {
    const std::size_t first = all.positions.size();
    all.Append(mesh, place);
    all.Paint(
        first,
        {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2]), 1},
        part);
  };
  add(urdf::BoxMesh(Eigen::Vector3d::Constant(kBlock)), Eigen::Affine3d::Identity(), kObjectColor);
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d along = Eigen::Vector3d::Unit(axis);
    Eigen::Affine3d place(Eigen::Translation3d(0.5 * kAxisLength * along));
    place.rotate(AlongZ(along));
    add(urdf::CylinderMesh(kAxisRadius, kAxisLength), place,
        kAxisColors[static_cast<std::size_t>(axis)]);
  }
}

std::unique_ptr<PartActor> MakeGroup() {
  urdf::Mesh mesh;
  for (int part = 0; part < static_cast<int>(kObjectsPerActor); ++part) AddObject(part, mesh);
  auto actor = std::make_unique<PartActor>(Pass::kSolid, PartActor::Light::kLit,
                                           static_cast<int>(kObjectsPerActor));
  actor->SetMesh(mesh);
  actor->SetCulling(true);
  return actor;
}

}  // namespace

bool ObjectActors::Update(const std::vector<TrackedObject>& objects, Liveness liveness,
                          std::vector<Label>& labels) {
  const std::size_t groups = (objects.size() + kObjectsPerActor - 1) / kObjectsPerActor;
  const bool is_changed = groups_.size() != groups;
  while (groups_.size() < groups) groups_.push_back(MakeGroup());
  groups_.resize(groups);
  const Eigen::Vector4f stale(static_cast<float>(kStaleBodyColor[0]),
                              static_cast<float>(kStaleBodyColor[1]),
                              static_cast<float>(kStaleBodyColor[2]), 1);
  names_.clear();
  for (std::size_t i = 0; i < groups * kObjectsPerActor; ++i) {
    PartActor& actor = *groups_[i / kObjectsPerActor];
    const int part = static_cast<int>(i % kObjectsPerActor);
    if (i >= objects.size()) {
      actor.Hide(part);
      continue;
    }
    const urdf::Pose& pose = objects[i].pose;
    actor.Place(part, Eigen::Translation3d(pose.position) * pose.orientation);
    names_.push_back(objects[i].name);
    labels.push_back({pose.position + Eigen::Vector3d(0, 0, kLabelHeight), objects[i].name});
  }
  for (const auto& group : groups_) {
    group->SetOverride(liveness == Liveness::kStale ? stale
                                                    : Eigen::Vector4f(Eigen::Vector4f::Zero()));
    group->Commit();
  }
  return is_changed;
}

std::vector<vtkActor*> ObjectActors::actors() {
  std::vector<vtkActor*> actors;
  for (const auto& group : groups_) actors.push_back(group->actor());
  return actors;
}

std::vector<std::string> ObjectActors::NamesOf(const vtkActor* actor) {
  std::vector<std::string> names;
  for (std::size_t group = 0; group < groups_.size(); ++group) {
    if (groups_[group]->actor() != actor) continue;
    const std::size_t first = group * kObjectsPerActor;
    for (std::size_t i = first; i < std::min(names_.size(), first + kObjectsPerActor); ++i) {
      names.push_back("object " + names_[i]);
    }
  }
  return names;
}

void ObjectActors::AddTo(PictureRegion& region) const {
  for (const auto& group : groups_) group->AddTo(region);
}

}  // namespace kinescope::render
