/// What a source knows of the clock of a node that sends to it. Plain data.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace kinescope {

struct NodeClock {
  /// Stamps farther away are not those of a clock: a recording that is played, or a clock that was
  /// never set. Their times of arrival replace them.
  static constexpr std::int64_t kFarNanos = 86'400'000'000'000;

  std::string node;  // "/bridge_a"
  /// From a stamp to its arrival, by two clocks: of the last seconds the smallest and the largest,
  /// ns. It is the delay, less what the node's clock is ahead.
  std::int64_t least_lag_nanos = 0, most_lag_nanos = 0;
  /// Its clock minus this computer's, ns, and by how much that may be wrong; absent: the node does
  /// not tell its time, so delay and clock cannot be told apart.
  struct Offset {
    std::int64_t nanos = 0, uncertainty_nanos = 0;
  };
  std::optional<Offset> offset;
  std::int64_t shift_nanos = 0;  // added to its stamps, so that they are of this computer's clock
  /// What shift_nanos has in it so that no stamp goes back. It shrinks by a tenth of the time that
  /// passes: until it is 0, stamps advance at 0.9 times the speed of time.
  std::int64_t excess_nanos = 0;
};

}  // namespace kinescope
