/// The meshes of bodies in memory: renderer and page ask for the same bodies, the page file by
/// file. Those that were asked for last are kept. Any thread; sets are made side by side, each
/// once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "server/body/body_meshes.h"

namespace kinescope::app {

class MeshMemory {
 public:
  static constexpr std::size_t kMaxSets = 32;
  static constexpr std::uintmax_t kMaxBytes = 40'000'000;  // a usual body has 0.8 MB

  using Files = std::shared_ptr<const std::vector<MeshFile>>;

  /// The files of the set called `name`, which `make` returns. Waits for another thread that makes
  /// the same set, but for no other set. Null if making them fails; the next call tries again.
  Files Get(const std::string& name, const std::function<std::vector<MeshFile>()>& make);

 private:
  struct Set {
    std::string name;
    std::uintmax_t bytes = 0;  // guarded by MeshMemory::mutex_; 0 until it is made
    std::mutex making;         // locked before MeshMemory::mutex_
    Files files;               // guarded by `making`
  };
  std::shared_ptr<Set> Use(const std::string& name);
  void OnMade(Set& set, std::uintmax_t bytes);

  std::mutex mutex_;
  std::deque<std::shared_ptr<Set>> sets_;  // guarded by mutex_; the one used last is first
};

}  // namespace kinescope::app
