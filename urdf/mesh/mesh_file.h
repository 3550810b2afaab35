/// Reads the mesh files of URDFs: STL, DAE, OBJ, GLB, through assimp. Any thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "urdf/mesh/mesh.h"
#include "urdf/mesh/texture.h"

namespace kinescope::urdf {

/// Limits per file; a larger file is a mistake or an attack that would block rendering.
constexpr std::uintmax_t kMaxMeshBytes = 64u << 20;
constexpr std::size_t kMaxMeshTriangles = 500'000;

/// How the up axis of a COLLADA file is handled.
enum class ColladaUp {
  kAsTold,   // its <up_axis> becomes z
  kIgnored,  // ignored as in RViz and Gazebo, for which robots are modelled
};

/// Reads the file at an absolute path as a surface, in metres, z up. For COLLADA, the unit is
/// applied and the up axis handled as `up` states; GLB has y up; STL and OBJ define neither and are
/// not changed. `colors` is as long as `positions` if the file has colours, else empty; textures
/// are read if `textures` says how. `parts` is empty.
/// The extension determines the format. The file is checked before assimp reads it; counts that
/// exceed its bytes, unlimited nesting and a DOCTYPE are rejected.
/// @throws std::runtime_error with the file and the reason.
Mesh ReadMeshFile(const std::filesystem::path& path, ColladaUp up = ColladaUp::kAsTold,
                  TextureReading* textures = nullptr);

/// Reads a mesh from memory; `extension` such as ".stl", in lower case. Files that it refers to
/// (the colours of an OBJ, textures) are read from `folder`, and not at all if that is empty.
/// @throws std::runtime_error with the reason, without a file name.
Mesh ReadMesh(const std::string& bytes, const std::string& extension,
              const std::filesystem::path& folder, ColladaUp up = ColladaUp::kAsTold,
              TextureReading* textures = nullptr);

}  // namespace kinescope::urdf
