/// Counters of the server; shown under "http" in /api/v1/diagnostics. Server's thread only.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "server/http/tls_files.h"

namespace kinescope::http {

struct ClientCounters {
  std::uint64_t id = 0;  // +1 per WebSocket opened
  bool pictures = false;
  std::uint64_t states_sent = 0;
  std::uint64_t states_dropped = 0;  // replaced by a newer one before they were sent
  std::uint64_t pictures_sent = 0;
  std::uint64_t pictures_dropped = 0;
};

struct Counters {
  std::uint64_t requests = 0;
  std::uint64_t snapshots = 0;
  std::map<std::string, std::uint64_t> rejected;  // rejected requests by reason, a fixed set of
                                                  // reasons
  std::uint64_t opened = 0;                       // WebSockets
  std::uint64_t states_encoded = 0;
  std::uint64_t past_states_encoded = 0;
  std::uint64_t pictures_encoded = 0;
  ClientCounters closed;       // sums over closed connections
  std::uint64_t failures = 0;  // exceptions that ended a request
};

/// `diagnostics` (a JSON object) with the member "http" added. A text that is not a JSON object is
/// returned under "error", never thrown. `tls`: null if the server does not encrypt.
[[nodiscard]] std::string WithHttpCounters(const std::string& diagnostics, const Counters& counters,
                                           const std::vector<ClientCounters>& clients,
                                           const TlsStatus* tls);

}  // namespace kinescope::http
