/// Lines and arrows as triangles: tubes along points, cones. No VTK here.
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

/// Round and closed, `sides` around. Points that fall together with the one before are left out;
/// fewer than two that are left give nothing.
void AppendTube(const std::vector<TubePoint>& points, int sides, int part, urdf::Mesh& to);

/// An arrow along +z from the origin: shaft of radius `shaft`, head of radius `head` that takes the
/// last `head_length` of `length`.
urdf::Mesh ArrowMesh(double length, double shaft, double head, double head_length, int sides);

/// Shortest turn of +z to `direction`, which need not be of length 1.
Eigen::Quaterniond AlongZ(const Eigen::Vector3d& direction);

}  // namespace kinescope::render
