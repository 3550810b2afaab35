#include "server/ros/refusal.h"

#include <spdlog/spdlog.h>

#include "core/system/utf8.h"

namespace kinescope::ros_bridge {

bool CountRefused(const Refusal& refusal, InputCounters& counters) {
  ++counters.received;
  counters.last_problem = refusal.text;
  return ++counters.refused[refusal.kind] == 1 && refusal.is_in_log;
}

void WarnOfRefused(const std::string& topic, const Refusal& refusal) {
  spdlog::warn("{}: {} (the next ones are counted: ros.inputs of /api/v1/diagnostics)", topic,
               PrintableLine(refusal.text));
}

}  // namespace kinescope::ros_bridge
