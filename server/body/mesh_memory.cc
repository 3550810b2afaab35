#include "server/body/mesh_memory.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <exception>
#include <utility>

namespace kinescope::app {

MeshMemory::Files MeshMemory::Get(const std::string& name,
                                  const std::function<std::vector<MeshFile>()>& make) {
  const std::shared_ptr<Set> set = Use(name);
  const std::lock_guard<std::mutex> guard(set->making);
  if (set->files != nullptr) return set->files;
  try {
    set->files = std::make_shared<const std::vector<MeshFile>>(make());
  } catch (const std::exception& error) {
    spdlog::warn("cannot make the meshes of a body: {}", error.what());
    return nullptr;
  }
  std::uintmax_t bytes = 0;
  for (const MeshFile& file : *set->files) bytes += file.stl.size();
  OnMade(*set, bytes);
  return set->files;
}

std::shared_ptr<MeshMemory::Set> MeshMemory::Use(const std::string& name) {
  const std::lock_guard<std::mutex> guard(mutex_);
  const auto found = std::find_if(sets_.begin(), sets_.end(), [&](const std::shared_ptr<Set>& set) {
    return set->name == name;
  });
  if (found != sets_.end()) {
    std::rotate(sets_.begin(), found, found + 1);
    return sets_.front();
  }
  sets_.push_front(std::make_shared<Set>());
  sets_.front()->name = name;
  if (sets_.size() > kMaxSets) sets_.pop_back();
  return sets_.front();
}

void MeshMemory::OnMade(Set& set, std::uintmax_t bytes) {
  const std::lock_guard<std::mutex> guard(mutex_);
  set.bytes = bytes;
  std::uintmax_t all = 0;
  for (const std::shared_ptr<Set>& each : sets_) all += each->bytes;
  while (all > kMaxBytes && sets_.size() > 1) {
    all -= sets_.back()->bytes;
    sets_.pop_back();
  }
}

}  // namespace kinescope::app
