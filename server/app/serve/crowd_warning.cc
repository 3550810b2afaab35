#include "server/app/serve/crowd_warning.h"

#include <spdlog/spdlog.h>

#include "server/mvn/assembler.h"
#include "server/mvn/datagram.h"

namespace kinescope::app {

void CrowdWarning::OnCounters(const SourceCounters& counters) {
  if (is_done_) return;
  const auto rejected = counters.rejected.find(mvn::Text(mvn::Reason::kTooManyStreams));
  if (rejected == counters.rejected.end()) return;
  is_done_ = true;
  spdlog::warn(
      "all {} places for people are taken; {} datagrams of further senders were rejected so far. "
      "--from ADDRESS admits only some senders",
      mvn::Assembler::kMaxStreams, rejected->second);
}

}  // namespace kinescope::app
