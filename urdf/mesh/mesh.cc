#include "urdf/mesh/mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_map>

namespace kinescope::urdf {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

Vector3f OnCircle(int step, int steps) {
  const double angle = 2 * M_PI * step / steps;
  return {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0};
}

// Two rows of `count` vertices, each row closed, first row above the second.
void Stitch(Mesh& mesh, std::uint32_t upper, std::uint32_t lower, int count) {
  for (int i = 0; i < count; ++i) {
    const auto here = static_cast<std::uint32_t>(i);
    const auto next = static_cast<std::uint32_t>((i + 1) % count);
    mesh.AddTriangle(upper + here, lower + here, lower + next);
    mesh.AddTriangle(upper + here, lower + next, upper + next);
  }
}

void Cap(Mesh& mesh, double radius, double z, int sides) {
  const Vector3f normal(0, 0, z > 0 ? 1 : -1);
  const std::uint32_t center = mesh.AddVertex({0, 0, static_cast<float>(z)}, normal);
  for (int i = 0; i < sides; ++i) {
    Vector3f point = static_cast<float>(radius) * OnCircle(i, sides);
    point.z() = static_cast<float>(z);
    mesh.AddVertex(point, normal);
  }
  for (int i = 0; i < sides; ++i) {
    const std::uint32_t a = center + 1 + static_cast<std::uint32_t>(i);
    const std::uint32_t b = center + 1 + static_cast<std::uint32_t>((i + 1) % sides);
    if (z > 0) {
      mesh.AddTriangle(center, a, b);
    } else {
      mesh.AddTriangle(center, b, a);
    }
  }
}

}  // namespace

std::uint32_t Mesh::AddVertex(const Vector3f& position, const Vector3f& normal) {
  positions.push_back(position);
  normals.push_back(normal);
  return static_cast<std::uint32_t>(positions.size() - 1);
}

void Mesh::AddTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  triangles.insert(triangles.end(), {a, b, c});
}

void Mesh::Append(const Mesh& other, const Eigen::Affine3d& transform) {
  const auto base = static_cast<std::uint32_t>(positions.size());
  const Eigen::Affine3f to = transform.cast<float>();
  const Eigen::Matrix3f turn = to.linear().inverse().transpose();
  for (std::size_t i = 0; i < other.positions.size(); ++i) {
    AddVertex(to * other.positions[i], (turn * other.normals[i]).normalized());
  }
  const bool mirrors = transform.linear().determinant() < 0;
  for (std::size_t i = 0; i + 2 < other.triangles.size(); i += 3) {
    const std::uint32_t a = base + other.triangles[i], b = base + other.triangles[i + 1],
                        c = base + other.triangles[i + 2];
    AddTriangle(a, mirrors ? c : b, mirrors ? b : c);
  }
  colors.insert(colors.end(), other.colors.begin(), other.colors.end());
  parts.insert(parts.end(), other.parts.begin(), other.parts.end());
}

void Mesh::Paint(std::size_t first, const Eigen::Vector4f& color, int part) {
  colors.resize(first);
  colors.resize(positions.size(), color);
  parts.resize(first);
  parts.resize(positions.size(), static_cast<float>(part));
}

bool Mesh::IsClosed() const {
  // Vertices at one point count as one: normals keep them apart at creases.
  std::map<std::array<float, 3>, std::uint32_t> index_of_point;
  std::vector<std::uint32_t> point_of_vertex;
  for (const Vector3f& p : positions) {
    const auto next = static_cast<std::uint32_t>(index_of_point.size());
    point_of_vertex.push_back(
        index_of_point.emplace(std::array{p.x(), p.y(), p.z()}, next).first->second);
  }
  std::unordered_map<std::uint64_t, int> balance;  // by edge, smaller point first
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t from = point_of_vertex[triangles[i + k]];
      const std::uint64_t to = point_of_vertex[triangles[i + (k + 1) % 3]];
      if (from < to) ++balance[from << 32 | to];
      if (from > to) --balance[to << 32 | from];
    }
  }
  return std::all_of(balance.begin(), balance.end(),
                     [](const auto& edge) { return edge.second == 0; });
}

Mesh SphereMesh(double radius, const ShapeDetail& detail) {
  const int by_size = radius > 0.07 ? 28 : 16;  // a head's outline shows, an elbow's does not
  const int around = detail.sphere_sides > 0 ? detail.sphere_sides : by_size;
  const int bands = around / 2;
  Mesh mesh;
  const auto r = static_cast<float>(radius);
  mesh.AddVertex({0, 0, r}, Vector3f::UnitZ());
  for (int band = 1; band < bands; ++band) {
    const double polar = M_PI * band / bands;
    for (int i = 0; i < around; ++i) {
      Vector3f normal = static_cast<float>(std::sin(polar)) * OnCircle(i, around);
      normal.z() = static_cast<float>(std::cos(polar));
      mesh.AddVertex(r * normal, normal);
    }
  }
  const std::uint32_t last = mesh.AddVertex({0, 0, -r}, -Vector3f::UnitZ());
  const auto row = static_cast<std::uint32_t>(around);
  for (std::uint32_t i = 0; i < row; ++i) {
    mesh.AddTriangle(0, 1 + i, 1 + (i + 1) % row);
    mesh.AddTriangle(last, last - row + (i + 1) % row, last - row + i);
  }
  for (std::uint32_t band = 0; band + 2 < static_cast<std::uint32_t>(bands); ++band) {
    Stitch(mesh, 1 + band * row, 1 + (band + 1) * row, around);
  }
  return mesh;
}

// A sphere pulled apart into the eight corners of a box: the rounded edges come by themselves.
Mesh BoxMesh(const Vector3d& size, const ShapeDetail& detail) {
  const double round = detail.box_rounding * size.minCoeff();
  const Vector3d half = 0.5 * size - Vector3d::Constant(round);
  constexpr int kAroundBox = 16, kRows = 8;  // rows: 4 in the upper corners, 4 in the lower
  Mesh mesh;
  for (int row = 0; row < kRows; ++row) {
    const bool is_upper = row < kRows / 2;
    const int step = is_upper ? row : row - 1;  // the equator is there twice, pulled apart in z
    const double polar = M_PI * step / (kRows - 2);
    for (int i = 0; i < kAroundBox; ++i) {
      // Likewise every quarter starts with a second copy of the corner's end.
      const int quarter = i / 4;
      const double angle = M_PI / 2 * (quarter + (i % 4) / 3.0);
      const Vector3d normal(std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle),
                            std::cos(polar));
      const Vector3d corner((quarter == 0 || quarter == 3 ? 1 : -1) * half.x(),
                            (quarter < 2 ? 1 : -1) * half.y(), (is_upper ? 1 : -1) * half.z());
      mesh.AddVertex((corner + round * normal).cast<float>(), normal.cast<float>());
    }
  }
  for (std::uint32_t row = 0; row + 1 < kRows; ++row) {
    Stitch(mesh, row * kAroundBox, (row + 1) * kAroundBox, kAroundBox);
  }
  // The poles have become rectangles.
  const std::uint32_t bottom = (kRows - 1) * kAroundBox;
  for (std::uint32_t i = 1; i + 1 < kAroundBox; ++i) {
    mesh.AddTriangle(0, i, i + 1);
    mesh.AddTriangle(bottom, bottom + i + 1, bottom + i);
  }
  return mesh;
}

Mesh CylinderMesh(double radius, double length, const ShapeDetail& detail) {
  const int sides = detail.cylinder_sides;
  Mesh mesh;
  for (const double z : {0.5 * length, -0.5 * length}) {
    for (int i = 0; i < sides; ++i) {
      const Vector3f normal = OnCircle(i, sides);
      mesh.AddVertex(static_cast<float>(radius) * normal + Vector3f(0, 0, static_cast<float>(z)),
                     normal);
    }
  }
  Stitch(mesh, 0, static_cast<std::uint32_t>(sides), sides);
  Cap(mesh, radius, 0.5 * length, sides);
  Cap(mesh, radius, -0.5 * length, sides);
  return mesh;
}

Mesh DiscMesh(int corners) {
  Mesh mesh;
  mesh.AddVertex(Vector3f::Zero(), Vector3f::UnitZ());
  for (int i = 0; i < corners; ++i) mesh.AddVertex(OnCircle(i, corners), Vector3f::UnitZ());
  for (int i = 0; i < corners; ++i) {
    mesh.AddTriangle(0, 1 + static_cast<std::uint32_t>(i),
                     1 + static_cast<std::uint32_t>((i + 1) % corners));
  }
  return mesh;
}

Mesh RingMesh(double inner_radius, int corners) {
  Mesh mesh;
  for (const double radius : {inner_radius, 1.0}) {
    for (int i = 0; i < corners; ++i) {
      mesh.AddVertex(static_cast<float>(radius) * OnCircle(i, corners), Vector3f::UnitZ());
    }
  }
  Stitch(mesh, 0, static_cast<std::uint32_t>(corners), corners);
  return mesh;
}

}  // namespace kinescope::urdf
