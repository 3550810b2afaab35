#include "render/shape/normal_match.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numeric>

namespace kinescope::render {
namespace {

using Eigen::Vector3f;
using skin::Triangle;

// The triangles at each vertex.
class TrianglesAround {
 public:
  TrianglesAround(const std::vector<Triangle>& triangles, std::size_t vertices)
      : starts_(vertices + 1), all_(3 * triangles.size()) {
    for (const Triangle& triangle : triangles) {
      for (const std::uint16_t corner : triangle) ++starts_[corner];
    }
    // First the end of each vertex' triangles, which moves to their start.
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    for (std::size_t i = triangles.size(); i-- > 0;) {
      for (const std::uint16_t corner : triangles[i]) {
        all_[--starts_[corner]] = static_cast<std::uint32_t>(i);
      }
    }
  }

  struct Range {
    const std::uint32_t *first, *last;
    const std::uint32_t* begin() const { return first; }
    const std::uint32_t* end() const { return last; }
  };
  Range operator[](std::size_t vertex) const {
    return {all_.data() + starts_[vertex], all_.data() + starts_[vertex + 1]};
  }

 private:
  std::vector<std::size_t> starts_;  // in `all_`; and its size
  std::vector<std::uint32_t> all_;
};

// For each vertex one of `used` that is near it over the surface; itself where no edge leads there.
std::vector<std::uint16_t> NearestUsed(const std::vector<Triangle>& triangles,
                                       const std::vector<std::uint16_t>& used,
                                       std::size_t vertices) {
  std::vector<std::uint16_t> nearest(vertices), queue = used;
  std::vector<bool> is_found(vertices, false);
  for (std::size_t i = 0; i < vertices; ++i) nearest[i] = static_cast<std::uint16_t>(i);
  for (const std::uint16_t vertex : used) is_found[vertex] = true;
  const TrianglesAround around(triangles, vertices);
  queue.reserve(vertices);
  for (std::size_t i = 0; i < queue.size(); ++i) {
    for (const std::uint32_t triangle : around[queue[i]]) {
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

Eigen::MatrixX3f ToRows(const std::vector<Vector3f>& vectors) {
  Eigen::MatrixX3f rows(static_cast<Eigen::Index>(vectors.size()), 3);
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    rows.row(static_cast<Eigen::Index>(i)) = vectors[i].transpose();
  }
  return rows;
}

}  // namespace

NormalMatch::NormalMatch(const std::vector<Vector3f>& positions,
                         const std::vector<Triangle>& triangles,
                         const std::vector<Triangle>& coarse) {
  std::vector<int> places(positions.size(), -1);  // of `used_`; -1: none
  for (const Triangle& triangle : coarse) {
    for (const std::uint16_t corner : triangle) places[corner] = 0;
  }
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (places[i] < 0) continue;
    places[i] = static_cast<int>(used_.size());
    used_.push_back(static_cast<std::uint16_t>(i));
  }
  const TrianglesAround around(coarse, positions.size());
  nearest_ = NearestUsed(triangles, used_, positions.size());
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
    for (const std::uint32_t index : around[nearest_[i]]) {
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
  const Eigen::MatrixX3f fine = ToRows(normals);
  const Eigen::MatrixX3f solved = solver_.solve(Eigen::MatrixX3f(weights_.transpose() * fine));
  std::vector<Vector3f> coarse(used_.size());
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    const Vector3f normal = solved.row(static_cast<Eigen::Index>(i)).transpose();
    const float length = normal.norm();
    coarse[i] = length > 0 ? Vector3f(normal / length) : normals[used_[i]];
  }
  return coarse;
}

std::vector<Vector3f> NormalMatch::Fine(const std::vector<Vector3f>& coarse) const {
  const Eigen::MatrixX3f between = weights_ * ToRows(coarse);
  std::vector<Vector3f> fine(nearest_.size());
  for (std::size_t i = 0; i < fine.size(); ++i) {
    fine[i] = between.row(static_cast<Eigen::Index>(i)).transpose();
  }
  return fine;
}

}  // namespace kinescope::render
