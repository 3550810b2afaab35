/// Mesh files, read by assimp: a module that is loaded when the first one is wanted, so that a
/// process whose figure is ours does not load it.
#pragma once

#include <filesystem>
#include <string>

#include "render/module.h"
#include "render/vtk/mesh.h"
#include "urdf/figure.h"

namespace kinescope::app {

/// All triangles of an STL, DAE, OBJ or GLB file, without normals: render/vtk/mesh_file.h says in
/// which units and axes.
/// @throws std::runtime_error naming the file and what is wrong with it (or with the module).
urdf::TriangleMesh ReadMesh(const std::filesystem::path& path);

/// What the module exports as `KinescopeMeshModule`; see render/module.h.
struct MeshModule {
  render::ModuleAbi<render::Mesh> abi;
  render::Mesh (*read)(const std::string& absolute_path);
};

}  // namespace kinescope::app
