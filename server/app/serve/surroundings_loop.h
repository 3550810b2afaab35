/// Makes what is beside the people, for the page, on a thread of its own: after each change, at
/// most ten times a second, and once a second while there are no viewers. Those of former states
/// are made when a viewer asks for them.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
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
  ~SurroundingsLoop() { End(); }
  SurroundingsLoop(const SurroundingsLoop&) = delete;
  SurroundingsLoop& operator=(const SurroundingsLoop&) = delete;

  /// Costs a comparison unless they have changed.
  void OnState(const std::shared_ptr<const SceneState>& state);

  /// Those of a former state; without content if they cannot be made. Null: they will be made, ask
  /// again.
  std::shared_ptr<const http::Surroundings> Of(const std::shared_ptr<const SceneState>& former);

  /// Makes nothing more, and does not call `has_viewers` any more.
  void End();

 private:
  using Clock = std::chrono::steady_clock;

  void Run();
  std::shared_ptr<const SceneState> Next(std::unique_lock<std::mutex>& lock);
  void Keep(std::shared_ptr<const http::Surroundings> surroundings);
  std::shared_ptr<const http::Surroundings> Kept(std::uint64_t revision) const;

  const std::function<bool()> has_viewers_;
  Latest<http::Surroundings>& made_;
  std::uint64_t seen_ = 0;  // by the thread that calls OnState
  std::mutex mutex_;
  std::condition_variable wake_;
  // Guarded by mutex_:
  std::shared_ptr<const SceneState> wanted_;             // the newest; null: nothing has changed
  Clock::time_point newest_due_;                         // not before
  std::deque<std::shared_ptr<const SceneState>> asked_;  // former ones
  std::deque<std::shared_ptr<const http::Surroundings>> kept_;  // last made or asked for: last
  bool is_ending_ = false;
  std::thread thread_;  // last: it uses all other members
};

}  // namespace kinescope::app
