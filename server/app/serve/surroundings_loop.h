/// Makes what is beside the people, for the page, on a thread of its own: after each change, at
/// most ten times a second, and once a second while there are no viewers.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "core/scene_state.h"
#include "core/system/latest.h"
#include "server/http/server.h"

namespace kinescope::app {

class SurroundingsLoop {
 public:
  /// `has_viewers` is called on its thread.
  SurroundingsLoop(std::function<bool()> has_viewers, Latest<http::Surroundings>& made);
  ~SurroundingsLoop();
  SurroundingsLoop(const SurroundingsLoop&) = delete;
  SurroundingsLoop& operator=(const SurroundingsLoop&) = delete;

  /// Costs a comparison unless they have changed.
  void OnState(const std::shared_ptr<const SceneState>& state);

 private:
  void Run();

  const std::function<bool()> has_viewers_;
  Latest<http::Surroundings>& made_;
  std::uint64_t seen_ = 0;  // by the thread that calls OnState
  std::mutex mutex_;
  std::condition_variable wake_;
  std::shared_ptr<const SceneState> wanted_;  // guarded by mutex_; null: nothing has changed
  bool is_ending_ = false;                    // guarded by mutex_
  std::thread thread_;                        // last: it uses all other members
};

}  // namespace kinescope::app
