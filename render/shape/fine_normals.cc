#include "render/shape/fine_normals.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace kinescope::render {
namespace {

using Eigen::Vector3f;
using Neighbours = std::vector<std::uint16_t>;

std::vector<Neighbours> NeighboursOf(const std::vector<skin::Triangle>& triangles,
                                     std::size_t vertices) {
  std::vector<Neighbours> all(vertices);
  for (const skin::Triangle& triangle : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (const std::size_t other : {(i + 1) % 3, (i + 2) % 3}) {
        Neighbours& known = all[triangle[i]];
        if (std::find(known.begin(), known.end(), triangle[other]) == known.end()) {
          known.push_back(triangle[other]);
        }
      }
    }
  }
  return all;
}

// The two whose edges are closest to a right angle, so that they span the surface.
std::array<std::uint16_t, 2> WidestPair(const Neighbours& neighbours, std::size_t vertex,
                                        const std::vector<Vector3f>& positions) {
  std::array<std::uint16_t, 2> widest = {static_cast<std::uint16_t>(vertex),
                                         static_cast<std::uint16_t>(vertex)};
  float largest_sine = 0;
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    const Vector3f a = (positions[neighbours[i]] - positions[vertex]).normalized();
    for (std::size_t j = 0; j < i; ++j) {
      const Vector3f b = (positions[neighbours[j]] - positions[vertex]).normalized();
      const float sine = a.cross(b).norm();
      if (!(sine > largest_sine)) continue;
      largest_sine = sine;
      widest = {neighbours[i], neighbours[j]};
    }
  }
  return widest;
}

}  // namespace

FineNormals::FineNormals(const std::vector<skin::Triangle>& triangles,
                         const std::vector<Posture>& postures) {
  constexpr float kFlat = 0.2f;    // the least sine between two edges that span a surface
  constexpr float kDoubt = 0.01f;  // how strongly the mean normal is preferred
  const std::vector<Vector3f>& positions = postures.front().coarse.positions;
  const std::vector<Neighbours> neighbours = NeighboursOf(triangles, positions.size());
  leans_.resize(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const auto [a, b] = WidestPair(neighbours[i], i, positions);
    const Vector3f to_a = positions[a] - positions[i], to_b = positions[b] - positions[i];
    const float length_a = to_a.norm(), length_b = to_b.norm();
    if (!(to_a.cross(to_b).norm() > kFlat * length_a * length_b)) continue;
    // Least squares over the postures.
    Eigen::Matrix3f square = kDoubt * Eigen::Matrix3f::Identity();
    Vector3f right = kDoubt * Vector3f::UnitX();
    for (const Posture& posture : postures) {
      const std::vector<Vector3f>& at = posture.coarse.positions;
      Eigen::Matrix3f basis;
      basis << posture.coarse.normals[i], (at[a] - at[i]) / length_a, (at[b] - at[i]) / length_b;
      square += basis.transpose() * basis;
      right += basis.transpose() * posture.normals[i];
    }
    const Vector3f lean = square.ldlt().solve(right);
    leans_[i] = {{a, b}, lean[0], {lean[1] / length_a, lean[2] / length_b}};
  }
}

void FineNormals::Apply(skin::PersonSkin::Surface& surface) const {
  const std::vector<Vector3f>& at = surface.positions;
  for (std::size_t i = 0; i < leans_.size(); ++i) {
    const Lean& lean = leans_[i];
    const Vector3f normal = lean.own * surface.normals[i] +
                            lean.along[0] * (at[lean.neighbours[0]] - at[i]) +
                            lean.along[1] * (at[lean.neighbours[1]] - at[i]);
    const float length = normal.norm();
    if (length > 0) surface.normals[i] = normal / length;
  }
}

}  // namespace kinescope::render
