#include "urdf/skin/occlusion.h"

#include <algorithm>
#include <utility>

#include "urdf/skin/frames.h"
#include "urdf/skin/limbs.h"

namespace kinescope::skin {
namespace {

using Eigen::Vector3f;
using urdf::At;

// Vertices at a time, as many as the processor's registers like.
constexpr Eigen::Index kBlock = 16;
using Block = Eigen::Array<float, kBlock, 1>;
struct Points {
  Block x, y, z, normal_x, normal_y, normal_z;
};

// Multiplies `open` by what the capsule leaves. `is_joined`: it begins away from its surface.
void Cover(const Points& p, const Capsule& capsule, bool is_joined, Block& open) {
  constexpr float kStrength = 0.8f;
  constexpr float kFadesIn = 2.5f;  // to 1.4 radii
  const Vector3f bone = capsule.end - capsule.start;
  const float inverse = 1 / std::max(bone.squaredNorm(), 1e-8f);
  const Block ax = p.x - capsule.start.x(), ay = p.y - capsule.start.y(),
              az = p.z - capsule.start.z();
  const Block along =
      ((ax * bone.x() + ay * bone.y() + az * bone.z()) * inverse).max(0.0f).min(1.0f);
  const Block dx = along * bone.x() - ax, dy = along * bone.y() - ay, dz = along * bone.z() - az;
  const Block squared = (dx * dx + dy * dy + dz * dz).max(1e-8f);
  const Block distance = squared.sqrt();
  const Block radius = capsule.start_radius + along * (capsule.end_radius - capsule.start_radius);
  const Block facing = ((dx * p.normal_x + dy * p.normal_y + dz * p.normal_z) / distance).max(0.0f);
  const Block size = (radius * radius / squared).min(1.0f);
  const Block covered = kStrength * facing * size;
  if (!is_joined) {
    open *= 1 - covered;
    return;
  }
  open *= 1 - covered * ((distance / radius - 1) * kFadesIn).max(0.0f).min(1.0f);
}

// Calls `cover(points, left)` for all points from `first` on, a block at a time; the last block
// repeats its last point.
template <class Position, class Normal, class CoverPoints>
void ForBlocks(std::size_t first, std::size_t count, const Position& position_of,
               const Normal& normal_of, const CoverPoints& cover, std::vector<float>& open) {
  const std::size_t end = first + count;
  for (; first < end; first += kBlock) {
    Points points;
    for (Eigen::Index k = 0; k < kBlock; ++k) {
      const std::size_t i = std::min(first + static_cast<std::size_t>(k), end - 1);
      const Vector3f position = position_of(i), normal = normal_of(i);
      points.x[k] = position.x();
      points.y[k] = position.y();
      points.z[k] = position.z();
      points.normal_x[k] = normal.x();
      points.normal_y[k] = normal.y();
      points.normal_z[k] = normal.z();
    }
    Block left = Block::Ones();
    cover(points, left);
    std::copy_n(left.data(), std::min<std::size_t>(kBlock, end - first), open.data() + first);
  }
}

// Farther off, a capsule covers less than a hundredth.
bool Matters(const Capsule& capsule, const Vector3f& center, float reach) {
  const float radius = std::max(capsule.start_radius, capsule.end_radius);
  const Vector3f bone = capsule.end - capsule.start;
  const float t = std::clamp(
      (center - capsule.start).dot(bone) / std::max(bone.squaredNorm(), 1e-8f), 0.0f, 1.0f);
  return (capsule.start + t * bone - center).norm() < reach + 9 * radius;
}

}  // namespace

Capsules CapsulesOf(const urdf::Skeleton& skeleton, const Build& build,
                    const urdf::LinkPoses& links) {
  const LimbShapes shapes = LimbShapesOf(skeleton, build);
  const auto place = [&](const LimbEnd& end) {
    const urdf::Pose& link = links[At(end.segment)];
    return Vector3f((link.position + link.orientation * end.point).cast<float>());
  };
  Capsules all;
  for (std::size_t i = 0; i < kLimbs; ++i) {
    const auto& [start, end] = shapes[i];
    all[i] = {place(start), place(end), static_cast<float>(start.radius),
              static_cast<float>(end.radius)};
  }
  return all;
}

Limb LimbOf(const VertexWeights& vertex) {
  std::array<int, kLimbs> shares{};
  for (std::size_t i = 0; i < kInfluences; ++i) {
    if (vertex.weights[i] == 0) break;
    shares[LimbOfSegment(Frames()[vertex.frames[i]].segment)] += vertex.weights[i];
  }
  return static_cast<Limb>(std::max_element(shares.begin(), shares.end()) - shares.begin());
}

std::vector<LimbRun> LimbRunsOf(const std::vector<VertexWeights>& vertices) {
  std::vector<LimbRun> runs;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Limb limb = LimbOf(vertices[i]);
    if (runs.empty() || runs.back().limb != limb) runs.push_back({limb, i, 0});
    ++runs.back().count;
  }
  return runs;
}

void SetOpenSky(const std::vector<Vector3f>& positions, const std::vector<Vector3f>& normals,
                const std::vector<LimbRun>& runs, const Capsules& capsules,
                std::vector<float>& open) {
  open.resize(positions.size());
  for (const LimbRun& run : runs) {
    Vector3f lowest = positions[run.first], highest = lowest;
    for (std::size_t i = run.first; i < run.first + run.count; ++i) {
      lowest = lowest.cwiseMin(positions[i]);
      highest = highest.cwiseMax(positions[i]);
    }
    std::vector<std::pair<const Capsule*, bool>> others;  // and whether it is joined
    for (std::size_t limb = 0; limb < kLimbs; ++limb) {
      const float reach = 0.5f * (highest - lowest).norm();
      const Covering covering = CoveringOf(run.limb, static_cast<Limb>(limb));
      if (covering == Covering::kNone) continue;
      if (Matters(capsules[limb], 0.5f * (lowest + highest), reach)) {
        others.emplace_back(&capsules[limb], covering == Covering::kJoined);
      }
    }
    ForBlocks(
        run.first, run.count, [&](std::size_t i) { return positions[i]; },
        [&](std::size_t i) { return normals[i]; },
        [&](const Points& points, Block& left) {
          for (const auto& [other, is_joined] : others) Cover(points, *other, is_joined, left);
        },
        open);
  }
}

void SetOpenSky(const std::vector<Vector3f>& floor, const Capsules& capsules,
                std::vector<float>& open) {
  open.resize(floor.size());
  ForBlocks(
      0, floor.size(), [&](std::size_t i) { return floor[i]; },
      [](std::size_t) { return Vector3f(Vector3f::UnitZ()); },
      [&](const Points& points, Block& left) {
        for (const Capsule& capsule : capsules) Cover(points, capsule, false, left);
      },
      open);
}

}  // namespace kinescope::skin
