#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/clocks.h"
#include "core/json_text.h"
#include "server/app/inspect/inspection_report.h"

namespace kinescope::app {
namespace {

using Json = nlohmann::ordered_json;
using mvn::CharacterKind;
using mvn::CharacterReport;
using mvn::InspectionReport;

double Millis(std::int64_t nanos) { return static_cast<double>(nanos) * 1e-6; }

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
  Json json;
  transport.Visit([&json](const char* name, std::uint64_t value) { json[name] = value; });
  return json;
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
          {"longest_silence_secs", Secs(character.longest_silence_nanos)},
          {"longest_silence_at_secs", Secs(character.longest_silence_at_nanos)}};
}

Json CharacterOf(const CharacterReport& character) {
  Json json = {{"sender", character.sender},
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
  if (character.color_rgb) json["color"] = fmt::format("#{:06x}", *character.color_rgb);
  json["types"] = Json::array();
  for (const mvn::TypeReport& type : character.types) json["types"].push_back(TypeOf(type));
  json["frames"] = FramesOf(character);
  json["samples"] = {{"count", character.samples},
                     {"incomplete", character.incomplete},
                     {"quantities", Json(character.quantities)}};
  json["duplicates"] = character.duplicates;
  json["late"] = character.late;
  json["outliers"] = character.outliers;
  json["odd_ids"] = character.odd_ids;
  json["advice"] = character.advice;
  return json;
}

Json ErrorOf(const mvn::ErrorReport& error, bool has_datagrams) {
  Json json = {{"reason", error.reason}, {"count", error.count}, {"first", nullptr}};
  if (!has_datagrams) return json;
  json["first"] = {{"at_secs", Secs(error.at_nanos)},
                   {"sender", error.sender},
                   {"offset", nullptr},
                   {"value", nullptr}};
  if (error.where) {
    json["first"]["offset"] = error.where->offset;
    json["first"]["value"] = error.where->value;
  }
  return json;
}

}  // namespace

std::string ReportJson(const InspectionReport& report) {
  Json json = {{"source", report.source},
               {"format", report.format},
               {"live", report.is_live},
               {"can_be_shown", report.CanBeShown()},
               {"has_datagrams", report.has_datagrams},
               {"has_arrival_times", report.has_arrival_times},
               {"begin_unix_secs", Secs(report.begin_wall_nanos)},
               {"end_unix_secs", Secs(report.end_wall_nanos)},
               {"secs", report.secs},
               {"datagrams", report.datagrams},
               {"bytes", report.bytes},
               {"transport", nullptr}};
  if (report.transport) json["transport"] = TransportOf(*report.transport);
  json["characters"] = Json::array();
  for (const auto& character : report.characters) {
    json["characters"].push_back(CharacterOf(character));
  }
  json["datagrams_not_kept"] = report.datagrams_not_kept;
  json["errors"] = Json::array();
  for (const auto& error : report.errors) {
    json["errors"].push_back(ErrorOf(error, report.has_datagrams));
  }
  json["ignored"] = Json(report.ignored);
  json["advice"] = report.advice;
  return JsonText(json, 2) + "\n";
}

}  // namespace kinescope::app
