#include "server/mvn/tally.h"

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
  counters.lost = lost;
  counters.delays = delays;
  counters.restarts = restarts;
  counters.outliers = outliers;
  for (std::size_t type = 0; type < types.size(); ++type) {
    if (types[type] > 0) counters.types[TypeDigits(static_cast<Type>(type))] = types[type];
  }
  for (std::size_t i = 0; i < rejected.size(); ++i) {
    if (rejected[i] > 0) counters.rejected[Text(static_cast<Reason>(i))] = rejected[i];
  }
  return counters;
}

}  // namespace kinescope::mvn
