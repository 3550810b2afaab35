/// Meshes of fewer triangles, for pictures in which what they show is small. Pure functions, any
/// thread.
#pragma once

#include "urdf/mesh/mesh.h"

namespace kinescope::render {

/// `mesh` with a part of its vertices and as few triangles as the error permits, by collapsing
/// edges (Garland and Heckbert 1997, as meshoptimizer does it). Normals, colours and parts are
/// those of the vertices that remain. Takes milliseconds for a body.
/// @param error_m how far the surface may move, m, > 0
urdf::Mesh CoarserMesh(const urdf::Mesh& mesh, double error_m);

}  // namespace kinescope::render
