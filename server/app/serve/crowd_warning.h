/// Warns once when datagrams are rejected because all places for people are taken: a suit may be
/// among their senders. One thread.
#pragma once

#include "core/source.h"

namespace kinescope::app {

class CrowdWarning {
 public:
  void OnCounters(const SourceCounters& counters);

 private:
  bool is_done_ = false;
};

}  // namespace kinescope::app
