/// Triangles ready to draw, and the shapes that URDF knows. Metres; no VTK here.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "urdf/robot_model.h"

namespace kinescope::urdf {

/// Vertices are shared between triangles; each belongs to one part (figure: a segment), which is
/// moved as a whole when it is drawn.
struct Mesh {
  std::vector<Eigen::Vector3f> positions;  // in the part's frame
  std::vector<Eigen::Vector3f> normals;    // unit, outwards
  std::vector<Eigen::Vector4f> colors;     // sRGB and opacity, 0..1
  std::vector<float> parts;                // index of the part
  std::vector<std::uint32_t> triangles;    // three vertices each, counter-clockwise from outside

  std::uint32_t AddVertex(const Eigen::Vector3f& position, const Eigen::Vector3f& normal);
  void AddTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  /// Appends `other`, moved by `transform` (may scale, may mirror).
  void Append(const Mesh& other, const Eigen::Affine3d& transform);
  /// Whether every edge between two points is run through as often one way as the other.
  bool IsClosed() const;
  /// Gives every vertex from `first` on this colour and part.
  void Paint(std::size_t first, const Eigen::Vector4f& color, int part);
};

/// How closely the shapes of a URDF are followed.
struct ShapeDetail {
  double box_rounding =
      0;  // radius of its edges, of its shortest side; light shows the shape by it
  int cylinder_sides = 0;
  int sphere_sides = 0;  // around its middle, even; 0: by its size

  /// As coarse and as soft as a figure of some 700 px height allows.
  static constexpr ShapeDetail Figure() { return {0.22, 16, 0}; }
  /// As the URDF says, but for a thin bright edge.
  static constexpr ShapeDetail Robot() { return {0.02, 48, 40}; }
};

/// Sizes as in urdf::Geometry. Colours and parts are left for Paint.
Mesh BoxMesh(const Eigen::Vector3d& size, const ShapeDetail& detail = ShapeDetail::Figure());
Mesh CylinderMesh(double radius, double length, const ShapeDetail& detail = ShapeDetail::Figure());
Mesh SphereMesh(double radius, const ShapeDetail& detail = ShapeDetail::Figure());

/// Flat, in the plane z = 0, facing up, radius 1.
Mesh DiscMesh(int corners);
Mesh RingMesh(double inner_radius, int corners);

}  // namespace kinescope::urdf
