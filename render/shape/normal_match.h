/// Which normals at the vertices of a coarse surface show a fine one best. Pure functions, any
/// thread.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <cstdint>
#include <vector>

#include "urdf/skin/skin_template.h"

namespace kinescope::render {

class NormalMatch {
 public:
  /// @param positions of the fine surface
  /// @param triangles of the fine surface
  /// @param coarse triangles between some of its vertices
  NormalMatch(const std::vector<Eigen::Vector3f>& positions,
              const std::vector<skin::Triangle>& triangles,
              const std::vector<skin::Triangle>& coarse);

  /// Normals which, interpolated over the coarse triangles, are closest to `normals` (least
  /// squares): at a vertex in a fold, rather those of what is around it than its own.
  /// @param normals of the fine surface, unit
  /// @return at the vertices that coarse triangles use, in their order, unit
  std::vector<Eigen::Vector3f> Coarse(const std::vector<Eigen::Vector3f>& normals) const;
  /// What normals at those vertices are in between, at all fine vertices; not unit.
  std::vector<Eigen::Vector3f> Fine(const std::vector<Eigen::Vector3f>& coarse) const;

  /// The fine vertices that coarse triangles use, ascending.
  const std::vector<std::uint16_t>& used() const { return used_; }
  /// For each fine vertex, the one of these that is near it over the surface.
  const std::vector<std::uint16_t>& nearest() const { return nearest_; }

 private:
  std::vector<std::uint16_t> used_, nearest_;
  Eigen::SparseMatrix<float> weights_;  // (fine vertices, used): interpolation
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<float>> solver_;
};

}  // namespace kinescope::render
