/// The normals of a fine surface at the vertices of a coarser one that moves. Coarse triangles are
/// seen as facets where each vertex has their mean normal. Pure functions, any thread.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "urdf/skin/person_skin.h"
#include "urdf/skin/skin_template.h"

namespace kinescope::render {

class FineNormals {
 public:
  /// Leaves all normals as they are.
  FineNormals() = default;
  /// One posture of both surfaces, with the same vertices: `normals` of `coarse` are means of its
  /// own triangles.
  struct Posture {
    skin::PersonSkin::Surface coarse;
    std::vector<Eigen::Vector3f> normals;  // of the fine surface, unit
  };
  /// @param triangles of the coarse surface
  /// @param postures at least one; between them and beyond, normals lean with the triangles
  FineNormals(const std::vector<skin::Triangle>& triangles, const std::vector<Posture>& postures);

  /// @param surface the coarse one, in any posture, with the means of its triangles as normals.
  /// Those become what the fine surface has there, about.
  void Apply(skin::PersonSkin::Surface& surface) const;

 private:
  // In the basis of the mean normal and of the edges to two neighbours.
  struct Lean {
    std::uint16_t neighbours[2] = {};
    float own = 1, along[2] = {};
  };
  std::vector<Lean> leans_;  // of each vertex
};

}  // namespace kinescope::render
