/// Decides which sender gives way when all places for senders are taken, so that a sender cannot
/// lock out a suit. Places are shared by machine, then by port: a sender displaces only one of a
/// machine that holds more places than its own. One that shows a body stays, unless its machine
/// holds more places than people of one MVN. Pure function, any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "server/mvn/endpoint.h"

namespace kinescope::mvn {

struct PlaceHolder {
  Endpoint sender;
  bool has_body = false;      // it has sent a whole body lately
  bool is_confirmed = false;  // it has sent anything that makes sense
  std::int64_t since_nanos = 0;
};

/// Index of the one that gives way to `newcomer`, in `holders`; nullopt: none does.
/// `newcomer_has_body`: it shows a whole body, or is certain to be who it says.
std::optional<std::size_t> WhoGivesWay(const std::vector<PlaceHolder>& holders,
                                       const Endpoint& newcomer, bool newcomer_has_body);

}  // namespace kinescope::mvn
