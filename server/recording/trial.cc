#include "server/recording/trial.h"

#include <nlohmann/json.hpp>

#include "core/system/clocks.h"
#include "core/system/json_parse.h"
#include "core/system/json_text.h"

namespace kinescope::recording {
namespace {

using nlohmann::json;

json ToJson(const TrialMoment& moment) {
  return {{"state", moment.state},
          {"micros", moment.made_nanos / 1000},
          {"stamp_micros", moment.stamp_nanos / 1000}};
}

std::int64_t Whole(const json& object, const char* name) {
  const auto found = object.find(name);
  const bool is_right = found != object.end() && found->is_number_integer();
  return is_right ? found->get<std::int64_t>() : 0;
}

std::string Text(const json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

// In ns; 0 for what no clock shows, so that differences are numbers.
std::int64_t NanosOf(const json& object, const char* name) {
  constexpr std::int64_t kMostMicros = 4'000'000'000'000'000;  // 126 years
  const std::int64_t micros = Whole(object, name);
  return micros >= 0 && micros <= kMostMicros ? 1000 * micros : 0;
}

TrialMoment MomentOf(const json& object) {
  if (!object.is_object()) return {};
  return {static_cast<std::uint64_t>(Whole(object, "state")), NanosOf(object, "micros"),
          NanosOf(object, "stamp_micros")};
}

}  // namespace

double LengthSecs(const Trial& trial) {
  return trial.to ? Secs(trial.to->made_nanos - trial.from.made_nanos) : 0;
}

std::string TitleOf(const Trial& trial) {
  return trial.person + " · " + trial.condition + " · trial " + std::to_string(trial.number);
}

std::string TrialText(const Trial& trial) {
  const json object = {
      {"trial", trial.stem},
      {"person", trial.person},
      {"condition", trial.condition},
      {"number", trial.number},
      {"run_micros", trial.run_micros},
      {"started_micros", trial.started_micros},
      {"from", ToJson(trial.from)},
      {"to", trial.to ? ToJson(*trial.to) : json()},
      {"length_secs", LengthSecs(trial)},
      {"mark", trial.mark ? json(*trial.mark) : json()},
      {"has_recording", trial.has_recording},
      {"recording_problem", trial.recording_problem},
      {"options", trial.options},
  };
  return JsonText(object, 2) + "\n";
}

std::optional<Trial> ReadTrial(std::string_view text) {
  const json object = ParseJson(text);
  if (!object.is_object()) return std::nullopt;
  Trial trial;
  trial.stem = Text(object, "trial");
  trial.person = Text(object, "person");
  trial.condition = Text(object, "condition");
  if (trial.stem.empty() || trial.person.empty()) return std::nullopt;
  constexpr std::int64_t kMostTrials = 9999;
  const std::int64_t number = Whole(object, "number");
  if (number < 1 || number > kMostTrials) return std::nullopt;
  trial.number = static_cast<int>(number);
  trial.run_micros = Whole(object, "run_micros");
  trial.started_micros = Whole(object, "started_micros");
  if (object.contains("from")) trial.from = MomentOf(object["from"]);
  if (object.contains("to") && object["to"].is_object()) trial.to = MomentOf(object["to"]);
  if (object.contains("mark") && object["mark"].is_number_unsigned()) {
    trial.mark = object["mark"].get<std::uint64_t>();
  }
  const auto has_recording = object.find("has_recording");
  trial.has_recording = has_recording != object.end() && *has_recording == true;
  trial.recording_problem = Text(object, "recording_problem");
  trial.options = Text(object, "options");
  return trial;
}

}  // namespace kinescope::recording
