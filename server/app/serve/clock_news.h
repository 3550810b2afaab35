/// What people and programs are told of the clocks of the nodes whose people are read: JSON, and a
/// sentence if a clock differs. Pure functions, any thread.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "core/node_clock.h"

namespace kinescope::app {

/// From a stamp to its arrival, by one clock; nullopt: the node does not tell its time.
struct Delay {
  double least_millis = 0, most_millis = 0;
};
[[nodiscard]] std::optional<Delay> DelayOf(const NodeClock& clock);

/// That the clock of the node differs, what follows and what to do, and that its stamps advance
/// more slowly than time; "" if neither is so.
[[nodiscard]] std::string ClockWarning(const NodeClock& clock);

/// An entry of `clocks` (docs/http.md).
[[nodiscard]] nlohmann::json ClockJson(const NodeClock& clock);

}  // namespace kinescope::app
