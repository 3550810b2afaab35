#include "server/mvn/tally.h"

#include <string>

namespace kinescope::mvn {

SourceCounters Tally::ToCounters() const {
  SourceCounters counters;
  counters.datagrams = datagrams;
  counters.bytes = bytes;
  counters.samples = samples;
  counters.incomplete = incomplete;
  counters.duplicates = duplicates;
  counters.late = late;
  counters.counter_gaps = counter_gaps;
  counters.restarts = restarts;
  for (std::size_t type = 0; type < ignored.size(); ++type) {
    if (ignored[type] == 0) continue;
    counters.ignored[(type < 10 ? "type 0" : "type ") + std::to_string(type)] = ignored[type];
  }
  for (std::size_t i = 0; i < rejected.size(); ++i) {
    if (rejected[i] > 0) counters.rejected[Text(static_cast<Reason>(i))] = rejected[i];
  }
  return counters;
}

}  // namespace kinescope::mvn
