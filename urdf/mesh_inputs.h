/// The files behind a mesh: which of them have changed decides whether a picture is still true.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kinescope::urdf {

/// `mesh` and, for an OBJ, the material files that it names and that exist. Reads no more than the
/// first 64 MiB. Never throws: a file that cannot be read has nothing behind it.
std::vector<std::filesystem::path> FilesOfMesh(const std::filesystem::path& mesh);

/// The material files that an OBJ names, as it names them; none of other files. Limits as above.
std::vector<std::string> MaterialNamesOf(const std::filesystem::path& mesh);

}  // namespace kinescope::urdf
