/// Mesh files that a URDF names: STL, DAE, OBJ, GLB, read by assimp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "urdf/mesh/mesh.h"

namespace kinescope::urdf {

/// What one file may hold; beyond is a mistake, or meant to stall every picture.
constexpr std::uintmax_t kMostMeshBytes = 64u << 20;
constexpr std::size_t kMostMeshTriangles = 500'000;

/// Which way a COLLADA file is turned.
enum class ColladaUp {
  kAsTold,   // its <up_axis> becomes z
  kIgnored,  // as RViz and Gazebo show it: robots are modelled for these, whatever the tag says
};

/// An absolute path as a surface, in metres, z up. COLLADA's unit is honoured, its up axis as asked
/// for, and that GLB has y up; STL and OBJ say neither and are taken as they are. `colors` is as
/// long as `positions` where the file gives colours, else empty; textures are not read. `parts` is
/// empty.
/// The file is looked over before assimp is given it: its kind goes by its extension, and a count
/// in it that its bytes cannot hold, nesting without end or a DOCTYPE refuses it.
/// @throws std::runtime_error naming the file and what is wrong with it.
Mesh ReadMeshFile(const std::filesystem::path& path, ColladaUp up = ColladaUp::kAsTold);

/// The same for bytes; `extension` such as ".stl", in lower case. Other files that it names (the
/// colours of an OBJ) are looked for in `folder`; in none when that is empty. @throws likewise,
/// without a file's name.
Mesh ReadMesh(const std::string& bytes, const std::string& extension,
              const std::filesystem::path& folder, ColladaUp up = ColladaUp::kAsTold);

}  // namespace kinescope::urdf
