#include "server/app/diagnostics.h"

#include <nlohmann/json.hpp>

namespace kinescope::app {

using nlohmann::json;

std::string DiagnosticsJson(const std::shared_ptr<const SceneState>& state,
                            const std::shared_ptr<const SourceCounters>& counters,
                            const std::optional<ros_bridge::BridgeStatus>& ros,
                            const std::optional<PictureStatus>& pictures) {
  json out;
  out["version"] = KINESCOPE_VERSION;
  if (state) {
    out["source"] = {{"url", state->source},
                     {"liveness", Name(state->liveness)},
                     {"rate_hz", state->rate_hz},
                     {"counter", state->counter}};
  }
  if (counters) {
    out["source"]["datagrams"] = counters->datagrams;
    out["source"]["bytes"] = counters->bytes;
    out["source"]["samples"] = counters->samples;
    out["source"]["incomplete"] = counters->incomplete;
    out["source"]["duplicates"] = counters->duplicates;
    out["source"]["late"] = counters->late;
    out["source"]["counter_gaps"] = counters->counter_gaps;
    out["source"]["restarts"] = counters->restarts;
    out["source"]["outliers"] = counters->outliers;
    out["source"]["types"] = counters->types;
    out["source"]["ignored"] = counters->ignored;
    out["source"]["rejected"] = counters->rejected;
    out["source"]["transport"] = counters->transport;
  }
  out["ros"] = nullptr;
  if (ros) {
    out["ros"] = {{"master_uri", ros->master_uri},
                  {"master_reachable", ros->master_reachable},
                  {"published", ros->published},
                  {"missed", ros->missed},
                  {"master_returns", ros->master_returns}};
  }
  out["pictures"] = nullptr;
  if (pictures) {
    out["pictures"] = {
        {"renderer", pictures->renderer},       {"drawn", pictures->drawn},
        {"draw_millis", pictures->draw_millis}, {"encode_millis", pictures->encode_millis},
        {"last_error", pictures->last_error},   {"problems", pictures->problems}};
  }
  // A file name need not be UTF-8.
  return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace kinescope::app
