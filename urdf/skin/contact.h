/// Where a joint bends far, the flesh on its hollow side meets: blended frames let it pass through
/// itself. Here it flattens against the plane in which the fold closes, which moves with the middle
/// frame of the joint's swing, and gives way along the fold. Nothing changes at small bends. Bind
/// pose, metres. Pure functions, any thread.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "urdf/skin/bind_pose.h"
#include "urdf/skin/skin_template.h"

namespace kinescope::skin {

/// Where a share grows from 0 to 1, smoothly.
struct Growth {
  double from = 0, to = 1;

  double At(double x) const {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
  }
};

/// A bend is given by the cosine of its angle: flesh meets from 60 degrees on, wholly from 90 on.
inline constexpr Growth kContact{0.5, 0};
/// Flesh this far from the plane bulges half as much as flesh at it, m.
inline constexpr float kBulgeReach = 0.04f;

/// The fold of an elbow, a knee or a hip. Directions are unit vectors.
struct FoldShape {
  int segment = 0;          // the joint's child
  std::vector<int> before;  // the segments on the other side of the plane
  int frame = 0;            // of Frames(): carries the plane
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();   // of the plane, away from the child
  Eigen::Vector3d across = Eigen::Vector3d::UnitY();   // along the fold
  Eigen::Vector3d inwards = Eigen::Vector3d::UnitX();  // from the bone to the hollow side
  Growth pressed{-0.02, 0.01};                         // flesh this far inwards, m
  Growth bulging{-0.03, 0.02};                         // the same
  /// From the midline of the body, where both hips share the flesh; others are away from it.
  Eigen::Vector3d outwards = Eigen::Vector3d::Zero();
  Growth beside_midline{-2, -1};  // flesh this far outwards, m
  double softness = 0.005;        // pressed flesh goes past the plane by less than this, m
  double bulge = 0;               // how much wider flesh at the plane becomes
  Growth bulges{0, -1};           // at these bends
};
inline constexpr std::size_t kFolds = 6;
std::array<FoldShape, kFolds> FoldsOf(const BindPose& bind, double height);

/// What a fold does to a vertex.
struct FoldVertex {
  std::uint16_t vertex = 0;
  float side = 0;   // share of the press, negative on the child's side of the plane
  float floor = 0;  // how far it is past the plane in the bind pose, where it may stay, m; <= 0
  float bulge = 0;  // how much wider it becomes at the plane
};
/// Those that take part.
std::vector<FoldVertex> VerticesOf(const FoldShape& fold, const std::vector<Eigen::Vector3f>& rest,
                                   const std::vector<VertexWeights>& weights);

}  // namespace kinescope::skin
