/// Builds lines and arrows as triangles: tubes along points, cones. Metres; no VTK types. Pure
/// functions, any thread.
#pragma once

#include <vector>

#include "urdf/mesh/mesh.h"

namespace kinescope::render {

/// Radius 1 at z = 0, tip at z = 1, closed.
urdf::Mesh ConeMesh(int sides);

struct TubePoint {
  Eigen::Vector3d position;
  double radius;          // m
  Eigen::Vector4f color;  // sRGB and opacity
};

/// A round, closed tube with `sides` sides. Points equal to the one before are skipped; with fewer
/// than two remaining points nothing is added.
void AppendTube(const std::vector<TubePoint>& points, int sides, int part, urdf::Mesh& to);

/// An arrow along +z from the origin, m: shaft of radius `shaft`, head of radius `head` on the last
/// `head_length` of `length`.
urdf::Mesh ArrowMesh(double length, double shaft, double head, double head_length, int sides);

/// Shortest rotation from +z to `direction`, which need not be normalised.
Eigen::Quaterniond AlongZ(const Eigen::Vector3d& direction);

}  // namespace kinescope::render
