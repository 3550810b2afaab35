/// Meshes of fewer triangles, for pictures in which what they show is small. Pure functions, any
/// thread.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "urdf/mesh/mesh.h"

namespace kinescope::render {

/// Edges of a single triangle.
enum class OpenEdge { kMoves, kStays };

/// As few of `triangles` (three vertices each) as the error permits, by collapsing edges (Garland
/// and Heckbert 1997, as meshoptimizer does it), in an order that is fast to render. Vertices at
/// the same place count as one. Takes milliseconds for a body.
/// @param error_m how far the surface may move, m, > 0
std::vector<std::uint32_t> CoarserTriangles(const std::vector<Eigen::Vector3f>& positions,
                                            const std::vector<std::uint32_t>& triangles,
                                            double error_m, OpenEdge edge = OpenEdge::kMoves);

/// The largest of `errors`, ascending, that is not above `error_m`; 0 if all are. Meshes are made
/// for a few errors only, because each is kept.
double PermittedError(std::initializer_list<double> errors, double error_m);

/// `mesh` with CoarserTriangles() and the vertices that they use: those keep their normals, colours
/// and parts.
urdf::Mesh CoarserMesh(const urdf::Mesh& mesh, double error_m);

}  // namespace kinescope::render
