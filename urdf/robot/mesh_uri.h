/// Finds the file of a mesh that a URDF names. Reads the file system; any thread.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace kinescope::urdf {

struct MeshNotFound {
  std::string reason;  // with the name, the places that were searched and the remedy
};

/// Where package:// and relative names are searched. Empty: only absolute paths are found.
struct MeshSearch {
  std::filesystem::path urdf_folder;
  /// Searched in order. Each folder is a package, or contains packages at any depth that a
  /// workspace has.
  std::vector<std::filesystem::path> package_path;
  /// Meshes on web servers, by their addresses: their files, or why there are none
  /// (server/download/robot_meshes.h).
  std::map<std::string, std::variant<std::filesystem::path, MeshNotFound>> loaded;
  std::shared_ptr<const void> folder_of_loaded;  // deletes it with its last owner
};

/// For the URDF in `urdf_file`: first the entries of `package_path`, then those of
/// $ROS_PACKAGE_PATH. Packages around the URDF itself are searched last, upwards from its folder.
MeshSearch MakeMeshSearch(const std::filesystem::path& urdf_file,
                          const std::vector<std::string>& package_path);

/// The file of `uri`: package://name/path, file:///path, an absolute path, a path relative to
/// the URDF, or an address in `search.loaded`. Percent-encoding in URIs is decoded. The file
/// existed as a regular file at the time of the call.
std::variant<std::filesystem::path, MeshNotFound> FindMesh(const std::string& uri,
                                                           const MeshSearch& search);

}  // namespace kinescope::urdf
