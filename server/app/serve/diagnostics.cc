#include "server/app/serve/diagnostics.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/system/clocks.h"
#include "core/system/json_parse.h"
#include "core/system/json_text.h"

namespace kinescope::app {

namespace {

using nlohmann::json;

json ToJson(const ros_bridge::InputCounters& counters) {
  return {{"received", counters.received},
          {"used", counters.used},
          {"rejected", counters.refused},
          {"unknown_joints", counters.unknown_joints},
          {"skewed", counters.skewed},
          {"worst_skew_secs", counters.worst_skew_secs},
          {"last_problem", counters.last_problem}};
}

// Limits of the validity of a person's loads; empty without any.
json WarningsOf(const BodyForces& forces) {
  json warnings = json::array();
  const auto add = [&](std::string_view text) {
    if (!text.empty()) warnings.push_back(text);
  };
  if (forces.body_mass_is_assumed) add("the body mass is assumed");
  if (forces.com_disagrees) {
    add(
        fmt::format("centre of mass differs from MVN's by {:.0f} mm; check frames, segment lengths "
                    "and body data",
                    1000 * forces.com_minus_mvn->norm()));
  }
  add(forces.why_no_ground);
  add(forces.why_static);
  add(forces.why_other_metric);
  return warnings;
}

json LoadsOf(const SceneState& state) {
  json people = json::array();
  for (const PersonState& person : state.people) {
    const BodyForces& forces = person.forces;
    people.push_back({{"character", person.character},
                      {"metric", Name(forces.metric)},
                      {"mode", forces.is_dynamic ? "dynamic" : "static"},
                      {"warnings", WarningsOf(forces)},
                      {"com_minus_mvn_m",
                       forces.com_minus_mvn ? json(forces.com_minus_mvn->norm()) : json(nullptr)},
                      {"ground_is_measured", forces.ground_is_measured},
                      {"residual_force_share", forces.residual_force_share},
                      {"residual_moment_share", forces.residual_moment_share}});
  }
  return people;
}

}  // namespace

std::string DiagnosticsJson(const std::shared_ptr<const SceneState>& state,
                            const std::shared_ptr<const SourceCounters>& counters,
                            const std::optional<ros_bridge::BridgeStatus>& ros,
                            const std::optional<DrawingStatus>& pictures,
                            const std::optional<DrawingStatus>& view, std::uint64_t skipped,
                            const history::History* history, const StreamHealth* stream,
                            const alarms::Webhook* webhook) {
  json out;
  out["version"] = KINESCOPE_VERSION;
  if (state) {
    out["source"] = {
        {"url", state->source},
        {"liveness", Name(state->liveness)},
        {"rate_hz", state->rate_hz},
        {"counter", state->counter},
        {"behind_secs",
         state->waited_nanos > kOverloadNanos ? json(Secs(state->waited_nanos)) : json(0)},
        {"skipped", skipped},
        {"left_out", json::array()}};
    for (const LeftOutPerson& person : state->left_out) {
      out["source"]["left_out"].push_back(
          {{"character", person.character}, {"name", person.name}, {"reason", person.why}});
    }
  }
  if (counters) {
    out["source"]["datagrams"] = counters->datagrams;
    out["source"]["bytes"] = counters->bytes;
    out["source"]["samples"] = counters->samples;
    out["source"]["incomplete"] = counters->incomplete;
    out["source"]["duplicates"] = counters->duplicates;
    out["source"]["late"] = counters->late;
    out["source"]["counter_gaps"] = counters->counter_gaps;
    out["source"]["lost"] = counters->lost;
    out["source"]["restarts"] = counters->restarts;
    out["source"]["outliers"] = counters->outliers;
    out["source"]["types"] = counters->types;
    out["source"]["ignored"] = counters->ignored;
    out["source"]["rejected"] = counters->rejected;
    out["source"]["transport"] = counters->transport;
    out["source"]["problems"] = counters->problems;
    out["source"]["passed_secs"] = Secs(counters->passed_nanos);
  }
  out["stream"] = stream != nullptr ? ParseJsonOrThrow(StreamHealthJson(*stream)) : json(nullptr);
  if (state) out["loads"] = LoadsOf(*state);
  out["ros"] = nullptr;
  if (ros) {
    out["ros"] = {
        {"master_uri", ros->master_uri},         {"master_reachable", ros->master_reachable},
        {"published", ros->published},           {"missed", ros->missed},
        {"master_returns", ros->master_returns}, {"inputs", json::object()}};
    out["ros"]["rejected_calls"] = ros->rejected_calls;
    out["ros"]["frame"] = ros->frame;
    out["ros"]["not_shown"] = ros->not_shown;
    for (const auto& [topic, input] : ros->inputs) out["ros"]["inputs"][topic] = ToJson(input);
  }
  out["pictures"] = nullptr;
  if (pictures) {
    out["pictures"] = {{"renderer", pictures->renderer.renderer},
                       {"backend", pictures->renderer.backend},
                       {"gl_version", pictures->renderer.gl_version},
                       {"software", pictures->renderer.is_software},
                       {"note", pictures->renderer.note},
                       {"driver_hung", pictures->hangs},
                       {"drawn", pictures->drawn},
                       {"draw_millis", pictures->draw_millis},
                       {"encode_millis", pictures->deliver_millis},
                       {"last_error", pictures->last_error},
                       {"problems", pictures->problems}};
  }
  out["view"] = nullptr;
  if (view) {
    out["view"] = {{"listeners", view->viewers},       {"drawn", view->drawn},
                   {"draw_millis", view->draw_millis}, {"send_millis", view->deliver_millis},
                   {"last_error", view->last_error},   {"driver_hung", view->hangs},
                   {"problems", view->problems}};
  }
  out["history"] = nullptr;
  if (history != nullptr) {
    const history::Extent kept = history->extent().value_or(history::Extent{});
    out["history"] = {{"secs", Secs(kept.last_nanos - kept.first_nanos)},
                      {"states", kept.last_number - kept.first_number + 1},
                      {"bytes", history->bytes()},
                      {"series_bytes", history->series().bytes()},
                      {"marker_bytes", history->marker_bytes()},
                      {"left_out", history->left_out()}};
  }
  out["webhook"] = nullptr;
  if (webhook != nullptr) {
    const alarms::WebhookCounters told = webhook->counters();
    out["webhook"] = {{"delivered", told.delivered},
                      {"failed", told.failed},
                      {"dropped", told.dropped},
                      {"last_error", told.last_error}};
  }
  // A file name need not be UTF-8.
  return JsonText(out);
}

}  // namespace kinescope::app
