/// Converts between the wall clock, which stamps samples, and the clock of the ROS graph, where
/// that is a simulator's or a bag's (/use_sim_time). Such a clock is heard in ticks, runs slower or
/// faster than the wall clock, stands still, and jumps back when it is started over.
///
/// A line is laid over the ticks of the last two seconds, above all of them: a tick is never heard
/// early. No moment is later than the newest tick by more than the ticks are apart, so a clock that
/// stands still stops what is stamped by it. Any thread.
#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>

namespace kinescope::ros_bridge {

class RosClock {
 public:
  /// What both clocks show now, Unix epoch, ns; call it before the other functions, as often as
  /// they are needed. `ros_nanos` 0: the graph has no time yet.
  void Observe(std::int64_t wall_nanos, std::int64_t ros_nanos);

  bool has_time() const;

  /// The moment `wall_nanos` in the graph's time; nullopt while that has none.
  std::optional<std::int64_t> ToRos(std::int64_t wall_nanos) const;

  /// The opposite; `ros_nanos` itself while the graph has no time.
  std::int64_t FromRos(std::int64_t ros_nanos) const;

  /// How often the graph's clock has jumped.
  int jumps() const;

 private:
  struct Tick {
    std::int64_t wall_nanos = 0, ros_nanos = 0;
  };
  void Fit();

  mutable std::mutex mutex_;
  std::deque<Tick> ticks_;  // guarded by mutex_, as all below
  int jumps_ = 0;
  double rate_ = 1;             // graph's seconds per second
  std::int64_t base_wall_ = 0;  // on the line
  std::int64_t base_ros_ = 0;   // on the line
  std::int64_t latest_ = 0;     // that any moment may be
};

}  // namespace kinescope::ros_bridge
