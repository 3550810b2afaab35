/// Which machines may send to a receiver. Pure functions, any thread.
#pragma once

#include <string>

#include "core/system/ip_networks.h"
#include "server/mvn/endpoint.h"

namespace kinescope::mvn {

/// `from`: the machines that may send; empty: all.
[[nodiscard]] inline bool MaySend(const IpNetworks& from, const Endpoint& sender) {
  return from.empty() || from.Has(sender.address);
}

/// Logs that the receiver `description` rejects `sender`. Call it for the first stranger.
void WarnOfStranger(const std::string& description, const Endpoint& sender);

}  // namespace kinescope::mvn
