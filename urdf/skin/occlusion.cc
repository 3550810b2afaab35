#include "urdf/skin/occlusion.h"

#include <algorithm>
#include <bitset>
#include <utility>

#include "urdf/skin/frames.h"

namespace kinescope::skin {
namespace {

using Eigen::Vector3f;
using urdf::At;

Limb LimbOfSegment(int segment) {
  switch (segment) {
    case urdf::kPelvis: return kPelvisLimb;
    case urdf::kL5:
    case urdf::kL3: return kBellyLimb;
    case urdf::kNeck: return kNeckLimb;
    case urdf::kHead: return kHeadLimb;
    case urdf::kRightUpperArm: return kRightUpperArmLimb;
    case urdf::kRightForeArm: return kRightForeArmLimb;
    case urdf::kRightHand: return kRightHandLimb;
    case urdf::kLeftUpperArm: return kLeftUpperArmLimb;
    case urdf::kLeftForeArm: return kLeftForeArmLimb;
    case urdf::kLeftHand: return kLeftHandLimb;
    case urdf::kRightUpperLeg: return kRightThighLimb;
    case urdf::kRightLowerLeg: return kRightShankLimb;
    case urdf::kRightFoot:
    case urdf::kRightToe: return kRightFootLimb;
    case urdf::kLeftUpperLeg: return kLeftThighLimb;
    case urdf::kLeftLowerLeg: return kLeftShankLimb;
    case urdf::kLeftFoot:
    case urdf::kLeftToe: return kLeftFootLimb;
    default: return kChestLimb;  // T12, T8, shoulders
  }
}

// Those that do not cover each other, because their surfaces go over into one another.
std::bitset<kLimbs> Merged(Limb limb) {
  std::bitset<kLimbs> merged;
  merged.set(limb);
  const auto with = [&](std::initializer_list<Limb> others) {
    for (const Limb other : others) merged.set(other);
  };
  switch (limb) {
    case kPelvisLimb: with({kBellyLimb, kChestLimb, kRightThighLimb, kLeftThighLimb}); break;
    case kBellyLimb: with({kPelvisLimb, kChestLimb}); break;
    case kChestLimb: with({kPelvisLimb, kBellyLimb, kNeckLimb}); break;
    case kNeckLimb: with({kChestLimb, kHeadLimb}); break;
    case kHeadLimb: with({kNeckLimb}); break;
    case kRightThighLimb:
    case kLeftThighLimb: with({kPelvisLimb}); break;
    case kRightHandLimb: with({kRightForeArmLimb}); break;
    case kLeftHandLimb: with({kLeftForeArmLimb}); break;
    case kRightFootLimb: with({kRightShankLimb}); break;
    case kLeftFootLimb: with({kLeftShankLimb}); break;
    default: break;
  }
  return merged;
}

// Those that are joined: what lies on the one is skin of the other.
bool AreJoined(Limb a, Limb b) {
  if (a > b) std::swap(a, b);
  const bool is_arm = b == kRightUpperArmLimb || b == kLeftUpperArmLimb;
  const bool is_first_of_limb = is_arm || b == kRightThighLimb || b == kLeftThighLimb;
  return is_first_of_limb ? a == (is_arm ? kChestLimb : kPelvisLimb) : b == a + 1;
}

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
  const double size = skeleton.height > 0 ? skeleton.height / urdf::kReferenceHeight : 1;
  const double more = 1 + 0.16 * build.heavy;
  const auto end_of = [&](int segment) {
    const urdf::Pose& link = links[At(segment)];
    return Eigen::Vector3d(link.position + link.orientation * urdf::EndOf(skeleton, segment));
  };
  const auto capsule = [&](const Eigen::Vector3d& start, const Eigen::Vector3d& end,
                           double start_radius, double end_radius) {
    return Capsule{start.cast<float>(), end.cast<float>(),
                   static_cast<float>(size * more * start_radius),
                   static_cast<float>(size * more * end_radius)};
  };
  const auto along = [&](int segment, double start_radius, double end_radius) {
    return capsule(links[At(segment)].position, end_of(segment), start_radius, end_radius);
  };
  const auto at = [&](int segment) { return links[At(segment)].position; };
  Capsules all;
  all[kPelvisLimb] = capsule(at(urdf::kPelvis), at(urdf::kL5), 0.130, 0.120);
  all[kBellyLimb] = capsule(at(urdf::kL5), at(urdf::kT12), 0.115, 0.115);
  all[kChestLimb] =
      capsule(at(urdf::kT12), 0.4 * at(urdf::kT8) + 0.6 * at(urdf::kNeck), 0.125, 0.110);
  all[kNeckLimb] = along(urdf::kNeck, 0.055, 0.052);
  const urdf::Pose& head = links[urdf::kHead];
  const double head_length = skeleton.head_top_in_head.norm();
  const auto in_head = [&](double x, double z) {
    return Eigen::Vector3d(head.position +
                           head.orientation * Eigen::Vector3d(x, 0, z) * head_length);
  };
  all[kHeadLimb] = capsule(in_head(0.10, 0.15), in_head(0, 0.55), 0.062, 0.082);
  for (const bool is_left : {false, true}) {
    const int hand = is_left ? urdf::kLeftHand : urdf::kRightHand;
    const int foot = is_left ? urdf::kLeftFoot : urdf::kRightFoot;
    const auto arm = static_cast<std::size_t>(is_left ? kLeftUpperArmLimb : kRightUpperArmLimb);
    const auto leg = static_cast<std::size_t>(is_left ? kLeftThighLimb : kRightThighLimb);
    all[arm] = along(hand - 2, 0.050, 0.040);
    all[arm + 1] = along(hand - 1, 0.040, 0.028);
    all[arm + 2] = along(hand, 0.030, 0.022);
    all[leg] = along(foot - 2, 0.085, 0.058);
    all[leg + 1] = along(foot - 1, 0.055, 0.036);
    const urdf::Pose& ankle = links[At(foot)];
    const Eigen::Vector3d below =
        ankle.position + ankle.orientation * Eigen::Vector3d(-0.02, 0, -0.045) * size;
    all[leg + 2] = capsule(below, end_of(foot + 1), 0.034, 0.020);
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
    const std::bitset<kLimbs> merged = Merged(run.limb);
    std::vector<std::pair<const Capsule*, bool>> others;  // and whether it is joined
    for (std::size_t limb = 0; limb < kLimbs; ++limb) {
      const float reach = 0.5f * (highest - lowest).norm();
      if (merged.test(limb)) continue;
      if (Matters(capsules[limb], 0.5f * (lowest + highest), reach)) {
        others.emplace_back(&capsules[limb], AreJoined(run.limb, static_cast<Limb>(limb)));
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
