/// Writes the program status as the JSON of /api/v1/diagnostics (docs/http.md). Pure function, any
/// thread.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "core/scene_state.h"
#include "core/source.h"
#include "server/alarms/webhook.h"
#include "server/app/serve/stream_health.h"
#include "server/history/history.h"
#include "server/picture/drawing_loop.h"
#include "server/ros/bridge.h"

namespace kinescope::app {

/// Null or nullopt: that part does not exist. `skipped`: samples, to catch up with the stream.
std::string DiagnosticsJson(const std::shared_ptr<const SceneState>& state,
                            const std::shared_ptr<const SourceCounters>& counters,
                            const std::optional<ros_bridge::BridgeStatus>& ros,
                            const std::optional<DrawingStatus>& pictures,
                            const std::optional<DrawingStatus>& view = {},
                            std::uint64_t skipped = 0, const history::History* history = nullptr,
                            const StreamHealth* stream = nullptr,
                            const alarms::Webhook* webhook = nullptr);

}  // namespace kinescope::app
