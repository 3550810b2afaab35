#include "render/shape/coarser_skin.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "render/shape/coarser_mesh.h"
#include "render/shape/normal_match.h"
#include "render/shape/seen_poses.h"
#include "render/shape/wrong_light.h"
#include "urdf/kinematics.h"
#include "urdf/skin/outfit.h"
#include "urdf/skin/person_skin.h"

namespace kinescope::render {
namespace {

using Eigen::Vector3f;
using skin::SkinTemplate;
using skin::Triangle;
using Surface = skin::PersonSkin::Surface;

std::vector<bool> UsedVertices(std::size_t vertices, const std::vector<std::uint32_t>& triangles) {
  std::vector<bool> is_used(vertices, false);
  for (const std::uint32_t corner : triangles) is_used[corner] = true;
  return is_used;
}

// Folds and bulges of a few centimetres are 2.5 times as deep: they are seen by their light, which
// changes more than their outline does. Chosen by pictures of 800x800 beside those of the whole
// skin: with less, faces suffer; with more, the triangles cost more than they bring.
std::vector<Eigen::Vector3f> WithDeeperFolds(const skin::PersonSkin::Surface& surface,
                                             const std::vector<Triangle>& triangles) {
  constexpr float kDeeper = 1.5f;
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

// What is simplified, in all postures.
struct Whole {
  Whole(const SkinTemplate& skin_of, const skin::Build& build_of, const urdf::Skeleton& skeleton_of)
      : skin(skin_of),
        build(build_of),
        skeleton(skeleton_of),
        poses(SeenPoses(skeleton)),
        surfaces(poses.size()) {
    const skin::PersonSkin person(skin, build, skeleton);
    for (std::size_t i = 0; i < poses.size(); ++i) person.Pose(poses[i], {}, surfaces[i]);
  }

  const SkinTemplate& skin;
  const skin::Build& build;
  const urdf::Skeleton& skeleton;
  const std::vector<urdf::LinkPoses> poses;
  std::vector<Surface> surfaces;
};

// Of the whole, only the vertices that some triangles are between.
class Part {
 public:
  Part(const Whole& whole, const std::vector<std::uint32_t>& triangles)
      : whole_(whole),
        match_(whole.surfaces.front().positions, whole.skin.triangles, ToTriangles(triangles)),
        seen_(whole.poses.size()) {
    skin_.skin = Compact(whole.skin, UsedVertices(whole.skin.size(), triangles), triangles);
    const skin::PersonSkin person(skin_.skin, whole.build, whole.skeleton);
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      person.Pose(whole.poses[i], {}, seen_[i].coarse);
      seen_[i].normals = match_.Coarse(whole.surfaces[i].normals);
    }
    skin_.normals = FineNormals(skin_.skin.triangles, seen_);
  }

  // Of WrongLight.
  std::vector<float> WrongAreas() const {
    WrongLight wrong(match_, whole_.surfaces.front(), whole_.skin.triangles);
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      Surface shown = seen_[i].coarse;
      skin_.normals.Apply(shown);
      wrong.Add(whole_.surfaces[i], shown, skin_.skin.triangles);
    }
    return wrong.areas();
  }
  const CoarserSkin& skin() const { return skin_; }

 private:
  const Whole& whole_;
  const NormalMatch match_;
  std::vector<FineNormals::Posture> seen_;
  CoarserSkin skin_;
};

// Keeps the triangles at vertices where more than `least_area` is wrong, but at most `most`, those
// at the worst.
// @return whether there are any
bool KeepWrong(const std::vector<float>& wrong_areas, double least_area, std::size_t most,
               const std::vector<Triangle>& triangles, std::vector<bool>& is_kept) {
  std::vector<std::pair<float, std::size_t>> wrong;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto& [a, b, c] = triangles[i];
    const float area = std::max({wrong_areas[a], wrong_areas[b], wrong_areas[c]});
    if (!is_kept[i] && area > least_area) wrong.emplace_back(-area, i);
  }
  std::sort(wrong.begin(), wrong.end());
  wrong.resize(std::min(wrong.size(), most));
  for (const auto& [area, triangle] : wrong) is_kept[triangle] = true;
  return !wrong.empty();
}

}  // namespace

CoarserSkin MakeCoarserSkin(const SkinTemplate& skin, const skin::Build& build,
                            const urdf::Skeleton& skeleton, double error_m,
                            const std::function<bool(const Triangle&)>& is_kept) {
  constexpr double kUnseen = 2;          // squares of the error: about a pixel of wrong light
  constexpr std::size_t kMostShare = 4;  // a quarter more triangles, at most, to mend it
  const Whole whole(skin, build, skeleton);
  const std::vector<Vector3f> deeper = WithDeeperFolds(whole.surfaces.front(), skin.triangles);
  std::vector<bool> stays;
  for (const Triangle& triangle : skin.triangles) stays.push_back(is_kept(triangle));
  const auto simplified = [&] {
    std::vector<std::uint32_t> kept, others;
    for (std::size_t i = 0; i < stays.size(); ++i) {
      std::vector<std::uint32_t>& kind = stays[i] ? kept : others;
      kind.insert(kind.end(), skin.triangles[i].begin(), skin.triangles[i].end());
    }
    std::vector<std::uint32_t> triangles =
        CoarserTriangles(deeper, others, error_m, OpenEdge::kStays);
    triangles.insert(triangles.end(), kept.begin(), kept.end());
    return triangles;
  };
  const Part first(whole, simplified());
  const std::size_t most = first.skin().skin.triangles.size() / kMostShare;
  if (!KeepWrong(first.WrongAreas(), kUnseen * error_m * error_m, most, skin.triangles, stays)) {
    return first.skin();
  }
  return Part(whole, simplified()).skin();
}

CoarserSkin MakeCoarserSkin(const SkinTemplate& skin, const skin::Build& build,
                            const urdf::Skeleton& skeleton, double error_m) {
  constexpr double kFineBorders = 0.002;  // m
  std::vector<skin::Borders> suit;
  if (skin.colors.empty() && error_m <= kFineBorders) suit = skin::OutfitOf(skin, build);
  return MakeCoarserSkin(skin, build, skeleton, error_m,
                         [&](const Triangle& triangle) { return skin::HasBorder(suit, triangle); });
}

}  // namespace kinescope::render
