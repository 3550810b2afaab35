#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/system/clocks.h"
#include "core/system/json_text.h"
#include "server/app/inspect/inspection_report.h"
#include "server/app/ordered_json.h"

namespace kinescope::app {
namespace {

using mvn::CharacterKind;
using mvn::CharacterReport;
using mvn::InspectionReport;

template <class T>
Json OrNull(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json RateOrNull(double rate_hz) { return rate_hz > 0 ? Json(rate_hz) : Json(nullptr); }

const char* KindName(CharacterKind kind) {
  switch (kind) {
    case CharacterKind::kPerson: return "person";
    case CharacterKind::kObjects: return "objects";
    case CharacterKind::kUnknown: break;
  }
  return "unknown";
}

Json TransportOf(const mvn::TransportCounters& transport) {
  Json out;
  transport.Visit([&out](const char* name, std::uint64_t value) { out[name] = value; });
  return out;
}

Json TypeOf(const mvn::TypeReport& type) {
  return {{"type", fmt::format("{:02d}", type.type)},
          {"name", mvn::DialogName(type.type)},
          {"datagrams", type.datagrams},
          {"rate_hz", RateOrNull(type.rate_hz)},
          {"mean_bytes", static_cast<double>(type.bytes) / static_cast<double>(type.datagrams)},
          {"fewest_items", type.fewest_items},
          {"most_items", type.most_items},
          {"share_of_frames", OrNull(type.share)}};
}

Json FramesOf(const CharacterReport& character) {
  Json delays = nullptr;
  if (character.delays) {
    delays = {{"median", Millis(character.delays->median)},
              {"p95", Millis(character.delays->p95)},
              {"p99", Millis(character.delays->p99)},
              {"longest", Millis(character.delays->longest)}};
  }
  return {{"count", character.frames},
          {"first_counter", OrNull(character.first_counter)},
          {"last_counter", OrNull(character.last_counter)},
          {"usual_step", character.usual_step},
          {"smallest_step", character.smallest_step},
          {"largest_step", character.largest_step},
          {"lost", OrNull(character.lost)},
          {"restarts", character.restarts},
          {"rate_hz", RateOrNull(character.rate_hz)},
          {"capture_rate_hz", RateOrNull(character.capture_rate_hz)},
          {"jitter_ms", std::move(delays)},
          {"longest_silence_seconds", Secs(character.longest_silence_nanos)},
          {"longest_silence_at_seconds", Secs(character.longest_silence_at_nanos)}};
}

Json CharacterOf(const CharacterReport& character) {
  Json out = {{"sender", character.sender},
              {"id", character.id},
              {"name", character.name},
              {"kind", KindName(character.kind)},
              {"color", nullptr},
              {"height_m", OrNull(character.height_m)},
              {"segments",
               {{"body", character.body_segments},
                {"left_glove", character.left_fingers},
                {"right_glove", character.right_fingers},
                {"props", character.props},
                {"objects", character.objects},
                {"names", character.names}}},
              {"datagrams", character.datagrams},
              {"bytes", character.bytes},
              {"old_header", character.has_old_header}};
  out["floor"] = nullptr;
  if (character.floor) {
    const bool is_found = character.floor->why_not.empty();
    out["floor"] = {{"height_m", is_found ? Json(character.floor->height_m) : Json(nullptr)},
                    {"reason", is_found ? Json(nullptr) : Json(character.floor->why_not)}};
  }
  if (character.color_rgb) out["color"] = fmt::format("#{:06x}", *character.color_rgb);
  out["types"] = Json::array();
  for (const mvn::TypeReport& type : character.types) out["types"].push_back(TypeOf(type));
  out["frames"] = FramesOf(character);
  out["samples"] = {{"count", character.samples},
                    {"incomplete", character.incomplete},
                    {"quantities", Json(character.quantities)}};
  out["duplicates"] = character.duplicates;
  out["late"] = character.late;
  out["outliers"] = character.outliers;
  out["mismatched_ids"] = character.mismatched_ids;
  out["advice"] = character.advice;
  return out;
}

Json ErrorOf(const mvn::ErrorReport& error, bool has_datagrams) {
  Json out = {{"reason", error.reason}, {"count", error.count}, {"first", nullptr}};
  if (!has_datagrams) return out;
  out["first"] = {{"at_seconds", Secs(error.at_nanos)},
                  {"sender", error.sender},
                  {"offset", nullptr},
                  {"value", nullptr}};
  if (error.where) {
    out["first"]["offset"] = error.where->offset;
    out["first"]["value"] = error.where->value;
  }
  return out;
}

}  // namespace

std::string ReportJson(const InspectionReport& report) {
  Json out = {{"source", report.source},
              {"format", report.format},
              {"live", report.is_live},
              {"can_be_shown", report.CanBeShown()},
              {"has_datagrams", report.has_datagrams},
              {"has_arrival_times", report.has_arrival_times},
              {"begin_unix_seconds", Secs(report.begin_wall_nanos)},
              {"end_unix_seconds", Secs(report.end_wall_nanos)},
              {"seconds", report.secs},
              {"datagrams", report.datagrams},
              {"bytes", report.bytes},
              {"transport", nullptr}};
  if (report.transport) out["transport"] = TransportOf(*report.transport);
  out["characters"] = Json::array();
  for (const auto& character : report.characters) {
    out["characters"].push_back(CharacterOf(character));
  }
  out["datagrams_not_kept"] = report.datagrams_not_kept;
  out["errors"] = Json::array();
  for (const auto& error : report.errors) {
    out["errors"].push_back(ErrorOf(error, report.has_datagrams));
  }
  out["ignored"] = Json(report.ignored);
  out["advice"] = report.advice;
  return JsonText(out) + "\n";
}

}  // namespace kinescope::app
