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

  /// A normal, before it has the length 1: `own` times the mean of the triangles and `along` times
  /// the edges to two neighbours, 1/m.
  struct Lean {
    std::uint16_t neighbours[2] = {};
    float own = 1, along[2] = {};
  };
  /// Of each vertex.
  const std::vector<Lean>& leans() const { return leans_; }

 private:
  std::vector<Lean> leans_;
};

}  // namespace kinescope::render
