/// Reads mesh files through assimp, in a module that is loaded with the first file: a process with
/// the built-in body model does not load it. Any thread.
#pragma once

#include <filesystem>
#include <string>

#include "core/system/module_loader.h"
#include "urdf/body_surface.h"
#include "urdf/mesh/mesh.h"

namespace kinescope::app {

/// All triangles of an STL, DAE, OBJ or GLB file, without normals; units and axes as in
/// urdf/mesh/mesh_file.h.
/// @throws std::runtime_error with the file and the reason (or the reason why the module cannot be
/// loaded).
urdf::TriangleMesh ReadMesh(const std::filesystem::path& path);

/// The table that the module exports as `KinescopeMeshModule`; see core/system/module_loader.h.
struct MeshModule {
  ModuleAbi<urdf::Mesh> abi;
  urdf::Mesh (*read)(const std::string& absolute_path);
};

}  // namespace kinescope::app
