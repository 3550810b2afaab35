/// Serves one WebSocket client: reads its commands and sends the messages of the hub one at a time.
/// A message that is replaced by a newer one before it is sent is dropped and counted. Server's
/// thread only.
#pragma once

#include <cstdint>
#include <string>

#include "server/http/hub.h"
#include "server/http/incoming_request.h"
#include "server/http/role.h"
#include "server/http/stream.h"

namespace kinescope::http {

/// Accepts the WebSocket that `request` asks for, and serves it until one side ends it. `address`:
/// of the client, without port. `hub` is borrowed and must outlive the connection.
void ServeWebSocket(Stream stream, std::string address, Role role, Hub& hub, std::uint64_t id,
                    const IncomingRequest& request);

}  // namespace kinescope::http
