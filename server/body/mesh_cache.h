/// The meshes of bodies: in memory for this process, and as files for other programs that read
/// their URDFs, such as RViz, which finds them by file:// paths. A sink asks for the files when
/// another program needs them: see core/mesh_files.h. Any thread; several processes may share the
/// folder.
///
/// Each set of files has a folder of its own, which appears complete or not at all. Once all sets
/// together are larger or more than the limits, writing another one removes those that were not
/// used for the longest time. A set is in use, and stays, from Provide() until its MeshFiles is
/// destroyed: a shared lock (flock) tells this process and others. The system releases it when a
/// process ends, so a URDF that outlives its process may lose its meshes. `kinescope urdf --out
/// FOLDER` writes one that does not.
#pragma once

#include <cstddef>
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
  static constexpr std::size_t kDefaultSets = 200;              // for bodies with small meshes

  /// How long the files have to exist.
  enum class Lifetime { kProcess, kUser };

  /// For processes whose URDFs no other program reads. Its paths cannot exist, and it writes
  /// nothing.
  static std::shared_ptr<const MeshCache> InMemory();

  /// The cache of this user: $CACHE_DIRECTORY (of a service of systemd), $XDG_CACHE_HOME/kinescope,
  /// ~/.cache/kinescope; for kProcess else $XDG_RUNTIME_DIR/kinescope, else a temporary folder that
  /// is removed with the cache. The first that belongs to this user, cannot be written by
  /// other users, and is writable; it is created with mode 0700. Null without one; the log then
  /// says so.
  static std::shared_ptr<const MeshCache> OfUser(Lifetime lifetime);

  /// `root` must exist. `limit`: of all files, bytes. `sets`: largest number of sets.
  explicit MeshCache(std::filesystem::path root, std::uintmax_t limit = kDefaultLimit,
                     std::size_t sets = kDefaultSets);

  /// Folder of the set called `name`, which need not exist. Equal names stand for equal files.
  std::filesystem::path FolderOf(const std::string& name) const;

  /// The set called `name`; `make` returns its files and is called, on any thread, when their
  /// content is needed. It may outlive the cache.
  std::shared_ptr<const MeshFiles> Files(const std::string& name,
                                         std::function<std::vector<MeshFile>()> make) const;

 private:
  class Store;
  class Set;
  explicit MeshCache(std::shared_ptr<const Store> store);

  std::shared_ptr<const Store> store_;
};

}  // namespace kinescope::app
