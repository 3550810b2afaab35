/// Passes what operators change about people and limits from the page's thread to the reading
/// thread, which alone uses the scene builder. Of several changes that wait, the later one counts.
#pragma once

#include <array>
#include <map>
#include <mutex>
#include <optional>

#include "core/person_change.h"
#include "server/scene/scene_builder.h"

namespace kinescope::app {

class ChangeMailbox {
 public:
  /// @pre FindDefect(change) is ""; `character` is in the stream, which bounds their number
  void Put(int character, const PersonChange& change);  // any thread
  /// @pre FindDefect() of load settings with these limits is ""
  void Put(const std::array<double, 2>& class_limits);  // any thread

  void PassTo(SceneBuilder& builder);  // reading thread

 private:
  std::mutex mutex_;
  // Guarded by mutex_:
  std::map<int, PersonChange> people_;  // by character
  std::optional<std::array<double, 2>> class_limits_;
};

}  // namespace kinescope::app
