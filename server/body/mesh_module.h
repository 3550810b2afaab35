/// Mesh files, read by assimp: a module that is loaded when the first one is wanted, so that a
/// process whose figure is ours does not load it.
#pragma once

#include <filesystem>
#include <string>

#include "core/module_loader.h"
#include "urdf/figure.h"
#include "urdf/mesh/mesh.h"

namespace kinescope::app {

/// All triangles of an STL, DAE, OBJ or GLB file, without normals: urdf/mesh/mesh_file.h says in
/// which units and axes.
/// @throws std::runtime_error naming the file and what is wrong with it (or with the module).
urdf::TriangleMesh ReadMesh(const std::filesystem::path& path);

/// What the module exports as `KinescopeMeshModule`; see core/module_loader.h.
struct MeshModule {
  ModuleAbi<urdf::Mesh> abi;
  urdf::Mesh (*read)(const std::string& absolute_path);
};

}  // namespace kinescope::app
