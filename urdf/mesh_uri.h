/// From the name of a mesh in a URDF to a file. Looks at the file system; any thread.
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace kinescope::urdf {

/// Where package:// and relative names start. Empty: only absolute ones are found.
struct MeshSearch {
  std::filesystem::path urdf_folder;
  /// Searched in order. Each holds packages, at any depth that a workspace has, or is one.
  std::vector<std::filesystem::path> package_path;
};

/// For the URDF in `urdf_file`: the entries of --package-path, then those of $ROS_PACKAGE_PATH.
/// Packages around the URDF itself are found last, by walking up from it.
MeshSearch MakeMeshSearch(const std::filesystem::path& urdf_file,
                          const std::vector<std::string>& package_path);

struct MeshNotFound {
  std::string reason;  // names what was looked for and where, and what would help
};

/// The file that `uri` means: package://name/path, file:///path, an absolute path, a path relative
/// to the URDF. Percent-encoding is undone in URIs. The file was there as a regular file a moment
/// ago.
std::variant<std::filesystem::path, MeshNotFound> FindMesh(const std::string& uri,
                                                           const MeshSearch& search);

}  // namespace kinescope::urdf
