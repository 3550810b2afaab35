#include "render/vtk/force_arrows.h"

#include <vtkActor.h>

#include <algorithm>
#include <cmath>

#include "core/palette.h"
#include "render/shape/line_mesh.h"

namespace kinescope::render {
namespace {

constexpr double kShaft = 0.009, kHead = 0.024, kHeadLength = 0.06;  // m
constexpr float kGhostForceOpacity = 0.45f;
constexpr int kPartsOfArrow = 2;  // shaft, head
constexpr int kParts = 2 * kPartsOfArrow;

urdf::Mesh ArrowParts() {
  urdf::Mesh mesh;
  const Eigen::Vector4f color(static_cast<float>(kCopColor[0]), static_cast<float>(kCopColor[1]),
                              static_cast<float>(kCopColor[2]), 1);
  for (int part = 0; part < kParts; ++part) {
    const std::size_t first = mesh.positions.size();
    const bool is_shaft = part % kPartsOfArrow == 0;
    mesh.Append(is_shaft ? urdf::CylinderMesh(1, 1, {0, 16, 0}) : ConeMesh(20),
                Eigen::Affine3d(Eigen::Translation3d(0, 0, is_shaft ? 0.5 : 0)));
    mesh.Paint(first, color, part);
  }
  return mesh;
}

}  // namespace

ForceArrows::ForceArrows()
    : solid_(Pass::kSolid, PartActor::Light::kLit, kParts),
      ghost_(Pass::kGhost, PartActor::Light::kLit, kParts) {
  solid_.SetMesh(ArrowParts());
  ghost_.SetMesh(ArrowParts());
  ghost_.SetOpacity(kGhostForceOpacity);
}

std::vector<std::string> ForceArrows::Names() {
  std::vector<std::string> names(kParts, "force on the right foot");
  std::fill(names.begin() + kPartsOfArrow * urdf::kLeft, names.end(), "force on the left foot");
  return names;
}

void ForceArrows::Show(const PersonState& person, std::vector<Label>* labels) {
  bool is_any = false;
  for (PartActor* actor : {&solid_, &ghost_}) {
    for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
      const FootForce& foot = person.forces.feet[side];
      const int shaft = kPartsOfArrow * side, head = shaft + 1;
      actor->Hide(shaft);
      actor->Hide(head);
      const double force = foot.force.norm();
      if (!(force > kMinForceShown) || !std::isfinite(force) || !foot.cop.allFinite()) continue;
      is_any = true;
      const double length = kMetresPerNewton * force;
      const double head_length = std::min(kHeadLength, 0.6 * length);
      Eigen::Affine3d place(Eigen::Translation3d(foot.cop) * AlongZ(foot.force));
      const Eigen::Affine3d at_head = place * Eigen::Translation3d(0, 0, length - head_length);
      place.scale(Eigen::Vector3d(kShaft, kShaft, length - head_length));
      actor->Place(shaft, place);
      actor->Place(head, at_head * Eigen::Scaling(kHead, kHead, head_length));
      if (labels == nullptr || actor != &solid_) continue;
      labels->push_back({foot.cop + kMetresPerNewton * foot.force,
                         std::to_string(std::lround(force)) + " N", Label::Kind::kName});
    }
    actor->Commit();
  }
  solid_.actor()->SetVisibility(is_any);
  ghost_.actor()->SetVisibility(is_any);
}

}  // namespace kinescope::render
