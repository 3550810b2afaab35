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

 private:
  std::vector<std::uint16_t> used_;     // fine vertices of the coarse triangles, ascending
  Eigen::SparseMatrix<float> weights_;  // (fine vertices, used): interpolation
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<float>> solver_;
};

}  // namespace kinescope::render
