#include "render/shape/normal_match.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace kinescope::render {
namespace {

using Eigen::Vector3f;
using skin::Triangle;

std::vector<std::vector<std::uint16_t>> TrianglesAround(const std::vector<Triangle>& triangles,
                                                        std::size_t vertices) {
  std::vector<std::vector<std::uint16_t>> around(vertices);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (const std::uint16_t corner : triangles[i]) {
      around[corner].push_back(static_cast<std::uint16_t>(i));
    }
  }
  return around;
}

// For each vertex one of `used` that is near it over the surface; itself where no edge leads there.
std::vector<std::uint16_t> NearestUsed(const std::vector<Triangle>& triangles,
                                       const std::vector<std::uint16_t>& used,
                                       std::size_t vertices) {
  std::vector<std::uint16_t> nearest(vertices), queue = used;
  std::vector<bool> is_found(vertices, false);
  for (std::size_t i = 0; i < vertices; ++i) nearest[i] = static_cast<std::uint16_t>(i);
  for (const std::uint16_t vertex : used) is_found[vertex] = true;
  const auto around = TrianglesAround(triangles, vertices);
  queue.reserve(vertices);
  for (std::size_t i = 0; i < queue.size(); ++i) {
    for (const std::uint16_t triangle : around[queue[i]]) {
      for (const std::uint16_t corner : triangles[triangle]) {
        if (is_found[corner]) continue;
        is_found[corner] = true;
        nearest[corner] = nearest[queue[i]];
        queue.push_back(corner);
      }
    }
  }
  return nearest;
}

// Barycentric coordinates of the point of the triangle that is closest to `point`, about: outside,
// the coordinates are cut off.
Vector3f Inside(const Vector3f& a, const Vector3f& b, const Vector3f& c, const Vector3f& point) {
  const Vector3f normal = (b - a).cross(c - a);
  const float square = normal.squaredNorm();
  if (!(square > 0)) return Vector3f::UnitX();
  const float of_b = (point - a).cross(c - a).dot(normal) / square;
  const float of_c = (b - a).cross(point - a).dot(normal) / square;
  const Vector3f cut = Vector3f(1 - of_b - of_c, of_b, of_c).cwiseMax(0);
  return cut / cut.sum();
}

}  // namespace

NormalMatch::NormalMatch(const std::vector<Vector3f>& positions,
                         const std::vector<Triangle>& triangles,
                         const std::vector<Triangle>& coarse) {
  for (const Triangle& triangle : coarse)
    used_.insert(used_.end(), triangle.begin(), triangle.end());
  std::sort(used_.begin(), used_.end());
  used_.erase(std::unique(used_.begin(), used_.end()), used_.end());
  std::vector<int> places(positions.size(), -1);
  for (std::size_t i = 0; i < used_.size(); ++i) places[used_[i]] = static_cast<int>(i);
  const auto around = TrianglesAround(coarse, positions.size());
  const std::vector<std::uint16_t> nearest = NearestUsed(triangles, used_, positions.size());
  std::vector<Eigen::Triplet<float>> weights;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const int row = static_cast<int>(i);
    if (places[i] >= 0) {
      weights.emplace_back(row, places[i], 1.0f);
      continue;
    }
    float least = std::numeric_limits<float>::infinity();
    const Triangle* closest = nullptr;
    Vector3f shares;
    for (const std::uint16_t index : around[nearest[i]]) {
      const Triangle& t = coarse[index];
      const Vector3f &a = positions[t[0]], &b = positions[t[1]], &c = positions[t[2]];
      const Vector3f inside = Inside(a, b, c, positions[i]);
      const float distance =
          (inside[0] * a + inside[1] * b + inside[2] * c - positions[i]).squaredNorm();
      if (!(distance < least)) continue;
      least = distance;
      closest = &t;
      shares = inside;
    }
    if (closest == nullptr) continue;  // a piece that has vanished
    for (int corner = 0; corner < 3; ++corner) {
      weights.emplace_back(row, places[(*closest)[static_cast<std::size_t>(corner)]],
                           shares[corner]);
    }
  }
  const auto size = [](std::size_t count) { return static_cast<Eigen::Index>(count); };
  weights_.resize(size(positions.size()), size(used_.size()));
  weights_.setFromTriplets(weights.begin(), weights.end());
  solver_.compute(Eigen::SparseMatrix<float>(weights_.transpose() * weights_));
}

std::vector<Vector3f> NormalMatch::Coarse(const std::vector<Vector3f>& normals) const {
  Eigen::MatrixX3f fine(static_cast<Eigen::Index>(normals.size()), 3);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    fine.row(static_cast<Eigen::Index>(i)) = normals[i].transpose();
  }
  const Eigen::MatrixX3f solved = solver_.solve(Eigen::MatrixX3f(weights_.transpose() * fine));
  std::vector<Vector3f> coarse(used_.size());
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    const Vector3f normal = solved.row(static_cast<Eigen::Index>(i)).transpose();
    const float length = normal.norm();
    coarse[i] = length > 0 ? Vector3f(normal / length) : normals[used_[i]];
  }
  return coarse;
}

}  // namespace kinescope::render
