#include "render/shape/wrong_light.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace kinescope::render {

using Eigen::Vector3f;
using skin::Triangle;

WrongLight::WrongLight(const NormalMatch& match, const skin::PersonSkin::Surface& fine,
                       const std::vector<Triangle>& triangles)
    : match_(match), own_areas_(fine.positions.size()), areas_(fine.positions.size()) {
  for (const Triangle& triangle : triangles) {
    const Vector3f& a = fine.positions[triangle[0]];
    const Vector3f to_b = fine.positions[triangle[1]] - a, to_c = fine.positions[triangle[2]] - a;
    for (const std::uint16_t corner : triangle) own_areas_[corner] += to_b.cross(to_c).norm() / 6;
  }
}

void WrongLight::Add(const skin::PersonSkin::Surface& fine, const skin::PersonSkin::Surface& coarse,
                     const std::vector<Triangle>& coarse_triangles) {
  constexpr float kRight = 0.94f;  // the cosine of 20 degrees
  const std::vector<Vector3f> shown = match_.Fine(coarse.normals);
  std::vector<float> wrong(shown.size()), around(shown.size());
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const float length = shown[i].norm();
    const float cosine = length > 0 ? shown[i].dot(fine.normals[i]) / length : -1;
    if (cosine > kRight) continue;
    wrong[i] = own_areas_[i] * (1 - cosine);
    around[match_.nearest()[i]] += wrong[i];
  }
  for (std::size_t i = 0; i < shown.size(); ++i) {
    if (wrong[i] > 0) areas_[i] = std::max(areas_[i], around[match_.nearest()[i]]);
  }
  // Triangles that show their back are not drawn.
  for (const Triangle& triangle : coarse_triangles) {
    const Vector3f& a = coarse.positions[triangle[0]];
    const Vector3f facing =
        (coarse.positions[triangle[1]] - a).cross(coarse.positions[triangle[2]] - a);
    const auto faces_inwards = [&](std::uint16_t corner) {
      return facing.dot(fine.normals[match_.used()[corner]]) < 0;
    };
    if (!std::all_of(triangle.begin(), triangle.end(), faces_inwards)) continue;
    for (const std::uint16_t corner : triangle) {
      float& area = areas_[match_.used()[corner]];
      area = std::max(area, facing.norm() / 2);
    }
  }
}

}  // namespace kinescope::render
