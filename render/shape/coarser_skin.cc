#include "render/shape/coarser_skin.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>

#include "render/shape/coarser_mesh.h"
#include "render/shape/normal_match.h"
#include "urdf/kinematics.h"
#include "urdf/skin/person_skin.h"

namespace kinescope::render {
namespace {

using skin::SkinTemplate;
using skin::Triangle;

// As people work: what is round then needs triangles, though it may be flat in the bind pose.
urdf::LinkPoses BentPoses(const urdf::Skeleton& skeleton) {
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
  return urdf::ForwardKinematics(skeleton, {}, angles);
}

std::vector<bool> UsedVertices(std::size_t vertices, const std::vector<std::uint32_t>& triangles) {
  std::vector<bool> is_used(vertices, false);
  for (const std::uint32_t corner : triangles) is_used[corner] = true;
  return is_used;
}

// Folds and bulges of a few centimetres are three times as deep: they are seen by their light,
// which changes more than their outline does. Chosen by pictures of 1280x720, in which a person
// then has as little error with 9,000 triangles as with 13,000.
std::vector<Eigen::Vector3f> WithDeeperFolds(const skin::PersonSkin::Surface& surface,
                                             const std::vector<Triangle>& triangles) {
  constexpr float kDeeper = 2;
  constexpr int kRounds = 10;  // of smoothing; each over half an edge, 1 cm
  std::vector<Eigen::Vector3f> smooth = surface.positions;
  std::vector<Eigen::Vector4f> sums(smooth.size());  // of neighbours, and their number
  for (int round = 0; round < kRounds; ++round) {
    std::fill(sums.begin(), sums.end(), Eigen::Vector4f::Zero());
    for (const Triangle& triangle : triangles) {
      for (std::size_t i = 0; i < 3; ++i) {
        sums[triangle[i]] += smooth[triangle[(i + 1) % 3]].homogeneous();
      }
    }
    for (std::size_t i = 0; i < smooth.size(); ++i) {
      if (sums[i].w() > 0) smooth[i] = 0.5f * (smooth[i] + sums[i].hnormalized());
    }
  }
  std::vector<Eigen::Vector3f> deeper = surface.positions;
  for (std::size_t i = 0; i < deeper.size(); ++i) {
    const Eigen::Vector3f& normal = surface.normals[i];
    deeper[i] += kDeeper * normal.dot(deeper[i] - smooth[i]) * normal;
  }
  return deeper;
}

// The vertices that `is_used`, which `triangles` are between.
SkinTemplate Compact(const SkinTemplate& skin, const std::vector<bool>& is_used,
                     const std::vector<std::uint32_t>& triangles) {
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

std::vector<Triangle> ToTriangles(const std::vector<std::uint32_t>& corners) {
  std::vector<Triangle> triangles;
  triangles.reserve(corners.size() / 3);
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    triangles.push_back({static_cast<std::uint16_t>(corners[i]),
                         static_cast<std::uint16_t>(corners[i + 1]),
                         static_cast<std::uint16_t>(corners[i + 2])});
  }
  return triangles;
}

}  // namespace

CoarserSkin MakeCoarserSkin(const SkinTemplate& skin, const skin::Build& build,
                            const urdf::Skeleton& skeleton, double error_m,
                            const std::function<bool(const Triangle&)>& is_kept) {
  const skin::PersonSkin person(skin, build, skeleton);
  const urdf::LinkPoses postures[] = {BentPoses(skeleton),
                                      urdf::ForwardKinematics(skeleton, {}, {})};
  skin::PersonSkin::Surface fine;
  person.Pose(postures[0], {}, fine);
  std::vector<std::uint32_t> kept, others;
  for (const Triangle& triangle : skin.triangles) {
    std::vector<std::uint32_t>& kind = is_kept(triangle) ? kept : others;
    kind.insert(kind.end(), triangle.begin(), triangle.end());
  }
  std::vector<std::uint32_t> triangles =
      CoarserTriangles(WithDeeperFolds(fine, skin.triangles), others, error_m, OpenEdge::kStays);
  triangles.insert(triangles.end(), kept.begin(), kept.end());
  const std::vector<bool> is_used = UsedVertices(skin.size(), triangles);
  CoarserSkin coarser;
  coarser.skin = Compact(skin, is_used, triangles);
  const skin::PersonSkin coarser_person(coarser.skin, build, skeleton);
  const NormalMatch match(fine.positions, skin.triangles, ToTriangles(triangles));
  std::vector<FineNormals::Posture> seen;
  for (const urdf::LinkPoses& posture : postures) {
    person.Pose(posture, {}, fine);
    FineNormals::Posture& both = seen.emplace_back();
    coarser_person.Pose(posture, {}, both.coarse);
    both.normals = match.Coarse(fine.normals);
  }
  coarser.normals = FineNormals(coarser.skin.triangles, seen);
  return coarser;
}

}  // namespace kinescope::render
