#include "urdf/rig/rigged_skin.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "urdf/rig/bone_fit.h"
#include "urdf/rig/bones.h"
#include "urdf/rig/frame_weights.h"
#include "urdf/skeleton.h"
#include "urdf/skin/bind_pose.h"
#include "urdf/skin/frames.h"
#include "urdf/skin/occlusion.h"

namespace kinescope::rig {
namespace {

using Eigen::Affine3d;
using Eigen::Vector3d;
using urdf::At;

using Fit = std::array<Affine3d, urdf::kSegmentCount>;

// bind_from_rig of what hangs on a node. A helper bone of Kinescope's own rigs lies between two
// segments.
Affine3d FitOf(int node, const Bones& bones, const Fit& fit) {
  const int own = std::max(bones.segment_of[At(node)], 0), frame = bones.frame_of[At(node)];
  if (frame < 0 || skin::Frames()[At(frame)].kind != skin::FrameKind::kSwing) return fit[At(own)];
  const double t = skin::Frames()[At(frame)].share;
  Affine3d between = fit[At(own)];
  between.matrix() =
      (1 - t) * fit[At(urdf::kSegments[At(own)].parent)].matrix() + t * fit[At(own)].matrix();
  return between;
}

// What of a vertex is drawn: equal ones are one.
using Drawn = std::tuple<std::array<std::int32_t, 3>, std::array<int, 3>, std::uint32_t,
                         std::array<std::uint8_t, 4>, std::array<std::uint8_t, 4>>;

Drawn DrawnOf(const RigVertex& vertex, const Vector3d& at, const skin::VertexWeights& weights) {
  constexpr double kSamePlace = 1e-5;  // m
  constexpr float kSameNormal = 1.0f / 16;
  std::array<std::int32_t, 3> place{};
  std::array<int, 3> normal{};
  for (int axis = 0; axis < 3; ++axis) {
    place[At(axis)] = static_cast<std::int32_t>(std::lround(at[axis] / kSamePlace));
    normal[At(axis)] = static_cast<int>(std::lround(vertex.normal[axis] / kSameNormal));
  }
  return {place, normal, vertex.material, weights.frames, weights.weights};
}

std::uint8_t ToByte(float channel) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(channel, 0.0f, 1.0f)));
}

}  // namespace

skin::SkinTemplate SkinOf(const Rig& rig) {
  const Bones bones = FindBones(rig);
  const Fit fit = FitBones(rig, bones);
  const skin::BindPose bind = skin::BindPoseOf(urdf::DefaultSkeleton());
  std::vector<Affine3d> of_node;
  of_node.reserve(rig.nodes.size());
  for (std::size_t node = 0; node < rig.nodes.size(); ++node) {
    of_node.push_back(FitOf(static_cast<int>(node), bones, fit));
  }

  struct Placed {
    Eigen::Vector3f position;
    skin::VertexWeights weights;
    std::uint32_t material;
  };
  std::vector<Placed> placed;
  std::vector<std::uint32_t> place_of(rig.vertices.size());
  std::map<Drawn, std::uint32_t> known;
  constexpr double kFarthest = 20;  // m
  for (std::size_t i = 0; i < rig.vertices.size(); ++i) {
    const RigVertex& vertex = rig.vertices[i];
    Vector3d at = Vector3d::Zero();
    for (std::size_t k = 0; k < vertex.nodes.size(); ++k) {
      if (!(vertex.weights[k] > 0)) continue;
      at +=
          static_cast<double>(vertex.weights[k]) * (of_node[At(vertex.nodes[k])] * vertex.position);
    }
    if (!at.allFinite() || at.cwiseAbs().maxCoeff() > kFarthest) {
      throw std::runtime_error("a vertex is more than 20 m away from the body: remove it");
    }
    const skin::VertexWeights weights = WeightsOf(vertex, at, bones, bind);
    const auto [same, is_new] =
        known.emplace(DrawnOf(vertex, at, weights), static_cast<std::uint32_t>(placed.size()));
    if (is_new) placed.push_back({at.cast<float>(), weights, vertex.material});
    place_of[i] = same->second;
  }
  if (placed.size() > kMaxVertices) {
    throw std::runtime_error("has " + std::to_string(placed.size()) +
                             " vertices; expected at most " + std::to_string(kMaxVertices) +
                             ": reduce the mesh (Blender: modifier Decimate)");
  }

  // By limb, as skin::LimbRunsOf() likes them.
  std::vector<std::uint32_t> order(placed.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return skin::LimbOf(placed[a].weights) < skin::LimbOf(placed[b].weights);
  });
  std::vector<std::uint16_t> number(placed.size());
  skin::SkinTemplate made;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Placed& vertex = placed[order[i]];
    number[order[i]] = static_cast<std::uint16_t>(i);
    made.corners[0].push_back(vertex.position);
    made.weights.push_back(vertex.weights);
    const auto& color = rig.colors[vertex.material];
    made.colors.push_back({ToByte(color[0]), ToByte(color[1]), ToByte(color[2]), 255});
  }
  for (const auto& [a, b, c] : rig.triangles) {
    const skin::Triangle triangle = {number[place_of[a]], number[place_of[b]], number[place_of[c]]};
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) {
      continue;
    }
    made.triangles.push_back(triangle);
  }
  if (made.triangles.empty()) throw std::runtime_error("has no triangle with an area");
  made.is_two_sided = rig.is_two_sided;
  return made;
}

}  // namespace kinescope::rig
