/// How much of the sky reaches the skin and the floor around it: the body as a few capsules, each
/// of which covers a part of it (Quilez, "Capsule occlusion"; Iwanicki 2013 used ellipsoids so).
/// World, metres. Pure functions, any thread.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "urdf/kinematics.h"
#include "urdf/skeleton.h"
#include "urdf/skin/skin_template.h"

namespace kinescope::skin {

/// A cone with round ends.
struct Capsule {
  Eigen::Vector3f start = Eigen::Vector3f::Zero(), end = Eigen::Vector3f::Zero();
  float start_radius = 0, end_radius = 0;
};

enum Limb : std::uint8_t {
  kPelvisLimb,
  kBellyLimb,
  kChestLimb,
  kNeckLimb,
  kHeadLimb,
  kRightUpperArmLimb,
  kRightForeArmLimb,
  kRightHandLimb,
  kLeftUpperArmLimb,
  kLeftForeArmLimb,
  kLeftHandLimb,
  kRightThighLimb,
  kRightShankLimb,
  kRightFootLimb,
  kLeftThighLimb,
  kLeftShankLimb,
  kLeftFootLimb,
  kLimbs
};
using Capsules = std::array<Capsule, kLimbs>;

Capsules CapsulesOf(const urdf::Skeleton& skeleton, const Build& build,
                    const urdf::LinkPoses& links);

/// The limb that carries most of the vertex.
Limb LimbOf(const VertexWeights& vertex);

/// Vertices one after another that belong to one limb.
struct LimbRun {
  Limb limb = kPelvisLimb;
  std::size_t first = 0, count = 0;
};
/// Few if the vertices are sorted by limb, as those of BuiltInSkin() are.
std::vector<LimbRun> LimbRunsOf(const std::vector<VertexWeights>& vertices);

/// The share of the sky over each vertex that no limb covers, 0..1. A limb covers neither itself
/// nor the ones that it merges with. `normals`: unit.
void SetOpenSky(const std::vector<Eigen::Vector3f>& positions,
                const std::vector<Eigen::Vector3f>& normals, const std::vector<LimbRun>& runs,
                const Capsules& capsules, std::vector<float>& open);

/// The same for points of the floor, which look up.
void SetOpenSky(const std::vector<Eigen::Vector3f>& floor, const Capsules& capsules,
                std::vector<float>& open);

}  // namespace kinescope::skin
