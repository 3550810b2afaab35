#include "render/shape/coarser_skin.h"

#include <cmath>
#include <cstdint>
#include <initializer_list>

#include "render/shape/coarser_mesh.h"
#include "urdf/kinematics.h"
#include "urdf/skin/person_skin.h"

namespace kinescope::render {
namespace {

using skin::SkinTemplate;
using skin::Triangle;

// As people work: what is round then needs triangles, though it may be flat in the bind pose.
std::vector<Eigen::Vector3f> BentPositions(const SkinTemplate& skin, const skin::Build& build,
                                           const urdf::Skeleton& skeleton) {
  constexpr double kDegree = M_PI / 180;
  urdf::JointAngles angles{};
  const auto bend = [&](std::initializer_list<int> joints, double degrees) {
    for (const int joint : joints) angles[urdf::At(joint)].y() = kDegree * degrees;
  };
  bend({urdf::jL5S1, urdf::jL4L3, urdf::jL1T12, urdf::jT9T8, urdf::jT1C7}, 10);
  bend({urdf::jRightShoulder, urdf::jLeftShoulder}, -50);
  bend({urdf::jRightElbow, urdf::jLeftElbow}, -80);
  bend({urdf::jRightHip, urdf::jLeftHip}, -70);
  bend({urdf::jRightKnee, urdf::jLeftKnee}, 90);
  skin::PersonSkin::Surface surface;
  skin::PersonSkin(skin, build, skeleton)
      .Pose(urdf::ForwardKinematics(skeleton, {}, angles), {}, surface);
  return surface.positions;
}

// Those that `triangles` use.
SkinTemplate Compact(const SkinTemplate& skin, const std::vector<std::uint32_t>& triangles) {
  std::vector<bool> is_used(skin.size(), false);
  for (const std::uint32_t corner : triangles) is_used[corner] = true;
  std::vector<std::uint16_t> places(skin.size());
  SkinTemplate compact;
  compact.is_two_sided = skin.is_two_sided;
  for (std::size_t i = 0; i < skin.size(); ++i) {
    if (!is_used[i]) continue;
    places[i] = static_cast<std::uint16_t>(compact.weights.size());
    compact.weights.push_back(skin.weights[i]);
    if (!skin.colors.empty()) compact.colors.push_back(skin.colors[i]);
    for (std::size_t corner = 0; corner < SkinTemplate::kCorners; ++corner) {
      if (!skin.corners[corner].empty()) {
        compact.corners[corner].push_back(skin.corners[corner][i]);
      }
    }
  }
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    compact.triangles.push_back(
        {places[triangles[i]], places[triangles[i + 1]], places[triangles[i + 2]]});
  }
  return compact;
}

}  // namespace

SkinTemplate CoarserSkin(const SkinTemplate& skin, const skin::Build& build,
                         const urdf::Skeleton& skeleton, double error_m,
                         const std::function<bool(const Triangle&)>& is_kept) {
  std::vector<std::uint32_t> kept, others;
  for (const Triangle& triangle : skin.triangles) {
    std::vector<std::uint32_t>& kind = is_kept(triangle) ? kept : others;
    kind.insert(kind.end(), triangle.begin(), triangle.end());
  }
  std::vector<std::uint32_t> triangles =
      CoarserTriangles(BentPositions(skin, build, skeleton), others, error_m, OpenEdge::kStays);
  triangles.insert(triangles.end(), kept.begin(), kept.end());
  return Compact(skin, triangles);
}

}  // namespace kinescope::render
