#include "render/vtk/axes_actor.h"

#include "core/palette.h"
#include "render/shape/line_mesh.h"

namespace kinescope::render {
namespace {

constexpr double kFrameLength = 0.10, kFrameRadius = 0.0045;        // m, of a body 1.75 m tall
constexpr double kHalfJointAxis = 0.085, kJointAxisRadius = 0.003;  // m, of a body 1.75 m tall
constexpr float kGhostAxesOpacity = 0.5f;

// One axis of each link along z, of length and radius 1.
urdf::Mesh SticksMesh(const Rgb& rgb, bool is_two_sided) {
  urdf::Mesh mesh;
  const Eigen::Vector4f color(static_cast<float>(rgb[0]), static_cast<float>(rgb[1]),
                              static_cast<float>(rgb[2]), 1);
  for (int part = 0; part < urdf::kSegmentCount; ++part) {
    const std::size_t first = mesh.positions.size();
    mesh.Append(urdf::CylinderMesh(1, is_two_sided ? 2 : 1, {0, 10, 0}),
                Eigen::Affine3d(Eigen::Translation3d(0, 0, is_two_sided ? 0 : 0.5)));
    mesh.Paint(first, color, part);
  }
  return mesh;
}

// The directions in the world of what `segment`'s frame, or the joint that it hangs at, has.
Eigen::Matrix3d DirectionsOf(const PersonState& person, int segment, bool is_joint) {
  const Eigen::Quaterniond& child = person.links[urdf::At(segment)].orientation;
  if (!is_joint) return child.toRotationMatrix();
  const int joint = segment - 1;
  const Eigen::Quaterniond& parent = person.links[urdf::At(urdf::ParentOf(joint))].orientation;
  const double bend = person.angles[urdf::At(joint)].y();
  Eigen::Matrix3d axes;
  axes.col(0) =
      parent * Eigen::AngleAxisd(bend, Eigen::Vector3d::UnitY()) * Eigen::Vector3d::UnitX();
  axes.col(1) = parent * Eigen::Vector3d::UnitY();
  axes.col(2) = child * Eigen::Vector3d::UnitZ();
  return axes;
}

}  // namespace

AxesActor::AxesActor(Kind kind) : kind_(kind) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const urdf::Mesh mesh = SticksMesh(kAxisColors[axis], kind == Kind::kJoints);
    solid_[axis] =
        std::make_unique<PartActor>(Pass::kSolid, PartActor::Light::kFlat, urdf::kSegmentCount);
    ghost_[axis] =
        std::make_unique<PartActor>(Pass::kGhost, PartActor::Light::kFlat, urdf::kSegmentCount);
    solid_[axis]->SetMesh(mesh);
    ghost_[axis]->SetMesh(mesh);
    ghost_[axis]->SetOpacity(kGhostAxesOpacity);
  }
}

void AxesActor::Show(const PersonState& person) {
  const double height = person.model->human.skeleton.height;
  const double size = height > 0 ? height / urdf::kReferenceHeight : 1;
  const bool is_joint = kind_ == Kind::kJoints;
  const double length = size * (is_joint ? kHalfJointAxis : kFrameLength);
  const double radius = size * (is_joint ? kJointAxisRadius : kFrameRadius);
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    if (is_joint && segment == urdf::kPelvis) {  // hangs at no joint
      for (auto* actors : {&solid_, &ghost_}) {
        for (auto& actor : *actors) actor->Hide(segment);
      }
      continue;
    }
    const Eigen::Matrix3d directions = DirectionsOf(person, segment, is_joint);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Eigen::Affine3d place(Eigen::Translation3d(person.links[urdf::At(segment)].position) *
                            AlongZ(directions.col(static_cast<Eigen::Index>(axis))));
      place.scale(Eigen::Vector3d(radius, radius, length));
      solid_[axis]->Place(segment, place);
      ghost_[axis]->Place(segment, place);
    }
  }
  for (auto* actors : {&solid_, &ghost_}) {
    for (auto& actor : *actors) actor->Commit();
  }
}

std::vector<vtkActor*> AxesActor::solids() {
  return {solid_[0]->actor(), solid_[1]->actor(), solid_[2]->actor()};
}
std::vector<vtkActor*> AxesActor::ghosts() {
  return {ghost_[0]->actor(), ghost_[1]->actor(), ghost_[2]->actor()};
}

// The ghosts are where the solids are.
void AxesActor::AddTo(PictureRegion& region) const {
  for (const auto& actor : solid_) actor->AddTo(region);
}

}  // namespace kinescope::render
