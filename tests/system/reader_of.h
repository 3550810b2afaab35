#pragma once

#include <sys/types.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace kinescope::testing {

/// The id of another process that has `file` open; 0: none has.
inline pid_t ReaderOf(const std::filesystem::path& file) {
  namespace fs = std::filesystem;
  for (const auto& process : fs::directory_iterator("/proc")) {
    const int id = std::atoi(process.path().filename().c_str());
    if (id == 0 || id == ::getpid()) continue;
    std::error_code ignored;
    for (const auto& open : fs::directory_iterator(process.path() / "fd", ignored)) {
      if (fs::read_symlink(open.path(), ignored) == file) return id;
    }
  }
  return 0;
}

}  // namespace kinescope::testing
