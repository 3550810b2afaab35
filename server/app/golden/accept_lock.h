/// Those who accept pictures in a folder do so one after another: each reads golden.lock, changes
/// it and writes it, and what another one has accepted meanwhile would be lost. Linux; any thread.
#pragma once

#include <filesystem>

namespace kinescope::app {

/// Held as long as it lives, by one process at a time. It is of the open folder, so nothing is left
/// behind when a process is killed. Where the file system has no locks, it does nothing.
class AcceptLock {
 public:
  /// Waits for it, and says so. @throws std::runtime_error if the user stops the program.
  explicit AcceptLock(const std::filesystem::path& folder);
  ~AcceptLock();
  AcceptLock(const AcceptLock&) = delete;
  AcceptLock& operator=(const AcceptLock&) = delete;

 private:
  int folder_ = -1;  // -1: there is none, which others say
};

}  // namespace kinescope::app
