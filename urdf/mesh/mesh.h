/// Triangle meshes ready for rendering, and meshes of the URDF shapes. Metres; no VTK types. Plain
/// data and pure functions, any thread.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "urdf/robot/robot_model.h"

namespace kinescope::urdf {

/// Triangles share vertices. Each vertex belongs to one part (body model: one segment), which moves
/// as a whole when it is rendered.
struct Mesh {
  std::vector<Eigen::Vector3f> positions;  // in the part's frame
  std::vector<Eigen::Vector3f> normals;    // unit, outwards
  std::vector<Eigen::Vector4f> colors;     // sRGB and opacity, 0..1
  std::vector<float> parts;                // index of the part
  std::vector<std::uint32_t> triangles;    // three vertices each, counter-clockwise from outside

  std::uint32_t AddVertex(const Eigen::Vector3f& position, const Eigen::Vector3f& normal);
  void AddTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  /// Appends `other` after applying `transform` (may scale, may mirror).
  void Append(const Mesh& other, const Eigen::Affine3d& transform);
  /// Whether the triangles use every edge equally often in both directions.
  bool IsClosed() const;
  /// Sets colour and part of all vertices from index `first` on.
  void Paint(std::size_t first, const Eigen::Vector4f& color, int part);
};

/// How accurately the shapes of a URDF are approximated.
struct ShapeDetail {
  double box_rounding = 0;  // radius of the edges as a share of the shortest side; its highlight
                            // makes the shape visible
  int cylinder_sides = 0;
  int sphere_sides = 0;  // around the equator, even; 0: by its size

  /// As coarse and rounded as a body model of about 700 px height allows.
  static constexpr ShapeDetail Body() { return {0.22, 16, 0}; }
  /// As in the URDF, with a thin bright edge.
  static constexpr ShapeDetail Robot() { return {0.02, 48, 40}; }
};

/// Sizes as in urdf::Geometry. Call Paint for colours and parts.
Mesh BoxMesh(const Eigen::Vector3d& size, const ShapeDetail& detail = ShapeDetail::Body());
Mesh CylinderMesh(double radius, double length, const ShapeDetail& detail = ShapeDetail::Body());
Mesh SphereMesh(double radius, const ShapeDetail& detail = ShapeDetail::Body());

/// Flat, in the plane z = 0, facing up, outer radius 1 m.
Mesh DiscMesh(int corners);
Mesh RingMesh(double inner_radius, int corners);

}  // namespace kinescope::urdf
