/// Passes hand loads from any thread (HTTP) to the reading thread, which alone uses the scene
/// builder.
#pragma once

#include <map>
#include <mutex>
#include <string>

#include "core/force_inputs.h"

namespace kinescope::app {

class HandLoadMailbox {
 public:
  /// Adds a hand load; it replaces an earlier one of `character` that was not taken yet. Returns
  /// "", or why it was rejected. Any thread.
  [[nodiscard]] std::string Put(int character, const HandLoad& load);

  /// All hand loads since the last call, by character. Any thread.
  [[nodiscard]] std::map<int, HandLoad> TakeAll();

 private:
  std::mutex mutex_;
  std::map<int, HandLoad> loads_;  // guarded by mutex_; bounded: callers pass existing characters
                                   // only
};

}  // namespace kinescope::app
