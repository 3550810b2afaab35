/// Warns once if datagrams arrive for two seconds and none of them completes a pose: the most
/// likely problem with a suit whose streamer is configured for another program. One thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/source.h"

namespace kinescope::app {

class MissingPoseWarning {
 public:
  /// `source`: its URL, for the text. `now_nanos`: monotonic clock.
  void OnCounters(const SourceCounters& counters, const std::string& source,
                  std::int64_t now_nanos);

 private:
  std::optional<std::int64_t> since_nanos_;  // of the first datagrams
  bool is_done_ = false;
};

}  // namespace kinescope::app
