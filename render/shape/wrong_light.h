/// Finds where a coarse surface looks unlike the fine one, because its normals or its triangles
/// face elsewhere. Pure functions, any thread.
#pragma once

#include <cstdint>
#include <vector>

#include "render/shape/normal_match.h"
#include "urdf/skin/person_skin.h"
#include "urdf/skin/skin_template.h"

namespace kinescope::render {

class WrongLight {
 public:
  /// @param match from fine to coarse vertices, must outlive this
  /// @param fine, triangles: the fine surface in any posture
  WrongLight(const NormalMatch& match, const skin::PersonSkin::Surface& fine,
             const std::vector<skin::Triangle>& triangles);

  /// Both surfaces in one posture.
  /// @param coarse with the normals that will be shown
  /// @param coarse_triangles between vertices of `coarse`
  void Add(const skin::PersonSkin::Surface& fine, const skin::PersonSkin::Surface& coarse,
           const std::vector<skin::Triangle>& coarse_triangles);

  /// At each fine vertex: how much of the surface around it is wrong in the worst posture, m^2;
  /// less where it is only a bit wrong. 0: nothing at the vertex itself.
  const std::vector<float>& areas() const { return areas_; }

 private:
  const NormalMatch& match_;
  std::vector<float> own_areas_;  // m^2: a third of the triangles around each fine vertex
  std::vector<float> areas_;
};

}  // namespace kinescope::render
