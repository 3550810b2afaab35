/// A moment by two clocks. Values only; any thread.
#pragma once

#include <cstdint>

namespace kinescope::ros_bridge {

struct Now {
  /// Both are one: where time is not simulated, and in a recording.
  constexpr Now(std::int64_t both) : nanos(both), graph_nanos(both) {}
  constexpr Now(std::int64_t of_machine, std::int64_t of_graph)
      : nanos(of_machine), graph_nanos(of_graph) {}

  std::int64_t nanos;        // monotonic clock; in a recording, its own
  std::int64_t graph_nanos;  // what lifetimes and ages count by: of a simulator it may stand still
};

}  // namespace kinescope::ros_bridge
