/// Keeps the meshes of bodies as files in a folder of the user, so that every reader of their URDFs
/// (RViz, the renderer, the page) finds them by file:// paths. A reader asks for the files when it
/// needs them: see core/mesh_files.h. Any thread; several processes may share the folder.
///
/// Each set of files has a folder of its own, which appears complete or not at all. Once all sets
/// together are larger than the limit, writing another one removes those that were not used for
/// the longest time. A set is in use, and stays, from Provide() until its MeshFiles is destroyed:
/// a shared lock (flock) tells this process and others. The system releases it when a process
/// ends, so a URDF that outlives its process may lose its meshes. `kinescope urdf --out FOLDER`
/// writes one that does not.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/mesh_files.h"
#include "server/body/body_meshes.h"

namespace kinescope::app {

class MeshCache {
 public:
  static constexpr std::uintmax_t kDefaultLimit = 100'000'000;  // bytes, of about 120 bodies

  /// The cache of this user: $XDG_CACHE_HOME/kinescope, ~/.cache/kinescope, else in the temporary
  /// folder. Null if the folder cannot be written; the log then says so.
  static std::shared_ptr<const MeshCache> OfUser();

  /// `root` must exist. `limit`: of all files, bytes.
  explicit MeshCache(std::filesystem::path root, std::uintmax_t limit = kDefaultLimit);

  /// Folder of the set called `name`, which need not exist. Equal names stand for equal files.
  std::filesystem::path FolderOf(const std::string& name) const;

  /// The set called `name`; `make` returns its files and is called, on any thread, when they have
  /// to be written. It may outlive the cache.
  std::shared_ptr<const MeshFiles> Files(const std::string& name,
                                         std::function<std::vector<MeshFile>()> make) const;

 private:
  class Store;
  class Set;
  std::shared_ptr<const Store> store_;
};

}  // namespace kinescope::app
