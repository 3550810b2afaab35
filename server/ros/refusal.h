/// Why a message of another node is not used, and how that is counted and told. Any thread; the
/// counters are guarded by their owner.
#pragma once

#include <string>
#include <tl/expected.hpp>

#include "server/ros/bridge.h"

namespace kinescope::ros_bridge {

struct Refusal {
  const char* kind;         // from a fixed set; key of the counter
  std::string text;         // one line with the values
  bool is_in_log = true;    // false: it is no error, or the log has it already
  bool is_partial = false;  // the rest of the message is used
  bool may_come = false;    // what is missing: at the start, topics come in any order
};
inline Refusal Unreadable() {
  return {"unreadable", "a message that is truncated or has a wrong length field"};
}
template <class T>
using Taken = tl::expected<T, Refusal>;

/// True if it is worth a line in the log: the first of its kind.
bool CountRefused(const Refusal& refusal, InputCounters& counters);

/// Of which the next ones are counted only.
void WarnOfRefused(const std::string& topic, const Refusal& refusal);

}  // namespace kinescope::ros_bridge
