/// What tests ask of closed triangle surfaces.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "urdf/body_surface.h"

namespace kinescope::urdf::testing {

inline Eigen::Vector3d Vertex(const TriangleMesh& mesh, std::uint32_t index) {
  return mesh.vertices[index].cast<double>();
}

inline std::array<Eigen::Vector3d, 3> Corners(const TriangleMesh& mesh,
                                              const std::array<std::uint32_t, 3>& triangle) {
  return {Vertex(mesh, triangle[0]), Vertex(mesh, triangle[1]), Vertex(mesh, triangle[2])};
}

inline double Volume(const TriangleMesh& mesh) {
  double volume = 0;
  for (const auto& triangle : mesh.triangles) {
    const auto [a, b, c] = Corners(mesh, triangle);
    volume += a.dot(b.cross(c)) / 6;
  }
  return volume;
}

/// How often the surface winds round `point`: 0 outside, 1 inside a shell, more inside several,
/// less than 0 inside one that faces inwards.
inline double Winding(const TriangleMesh& mesh, const Eigen::Vector3d& point) {
  double solid_angle = 0;
  for (const auto& triangle : mesh.triangles) {
    auto [a, b, c] = Corners(mesh, triangle);
    a -= point;
    b -= point;
    c -= point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    solid_angle += 2 * std::atan2(a.dot(b.cross(c)),
                                  la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return solid_angle / (4 * M_PI);
}

inline bool Contains(const TriangleMesh& mesh, const Eigen::Vector3d& point) {
  return Winding(mesh, point) > 0.5;
}

/// The point of a triangle that is nearest to `point`.
inline Eigen::Vector3d NearestOf(const std::array<Eigen::Vector3d, 3>& corners,
                                 const Eigen::Vector3d& point) {
  const auto& [a, b, c] = corners;
  const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
  const Eigen::Vector3d foot = point - normal * normal.dot(point - a);
  bool is_inside = true;
  Eigen::Vector3d nearest = a;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d& from = corners[static_cast<std::size_t>(i)];
    const Eigen::Vector3d& to = corners[static_cast<std::size_t>((i + 1) % 3)];
    const Eigen::Vector3d edge = to - from;
    if (edge.cross(foot - from).dot(normal) < 0) is_inside = false;
    const double share = std::clamp(edge.dot(point - from) / edge.squaredNorm(), 0.0, 1.0);
    const Eigen::Vector3d on_edge = from + share * edge;
    if ((on_edge - point).norm() < (nearest - point).norm()) nearest = on_edge;
  }
  return is_inside ? foot : nearest;
}

}  // namespace kinescope::urdf::testing
