#include "server/app/serve/control_status.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/system/json_text.h"

namespace kinescope::app {
namespace {

using nlohmann::json;

const char* NameOf(recording::RawRecorder::State state) {
  switch (state) {
    case recording::RawRecorder::State::kOn: return "on";
    case recording::RawRecorder::State::kSaving: return "saving";
    case recording::RawRecorder::State::kOff: break;
  }
  return "off";
}

// Whole seconds and tenths of a megabyte: what changes faster cannot be read, and would be sent to
// all clients.
json RecordingToJson(const ControlStatus& status) {
  constexpr std::uint64_t kStep = 100'000;
  const recording::RawRecorder::Status& now = status.recording;
  const bool is_on = now.state == recording::RawRecorder::State::kOn;
  json left;
  if (status.free_bytes && now.bytes_per_sec > 0) {
    constexpr double kMostSecs = 1e7, kStepSecs = 60;
    const double secs = static_cast<double>(*status.free_bytes) / now.bytes_per_sec;
    left = secs < kStepSecs ? std::floor(secs)
                            : kStepSecs * std::floor(std::min(secs, kMostSecs) / kStepSecs);
  }
  return {{"why_not", status.why_no_recording},
          {"state", NameOf(now.state)},
          {"file", now.file},
          {"secs", is_on ? std::floor(now.secs) : std::round(10 * now.secs) / 10},
          {"bytes", is_on ? now.bytes / kStep * kStep : now.bytes},
          {"dropped", now.dropped},
          {"problem", now.problem},
          {"free_bytes",
           status.free_bytes ? json(*status.free_bytes / kStep / 10 * kStep * 10) : json()},
          {"secs_left", left}};
}

json TrialToJson(const recording::Trial& trial) {
  return {{"trial", trial.stem},
          {"person", trial.person},
          {"condition", trial.condition},
          {"number", trial.number},
          {"started_micros", trial.started_micros},
          {"secs", std::round(100 * LengthSecs(trial)) / 100},
          {"from_micros", trial.from.made_nanos / 1000},
          {"to_micros", trial.to ? json(trial.to->made_nanos / 1000) : json()},
          {"run_micros", trial.run_micros},
          {"has_recording", trial.has_recording},
          {"recording_problem", trial.recording_problem}};
}

json JobToJson(const Workshop::Job& job) {
  return {{"id", job.id},
          {"kind", job.kind},
          {"file", job.file},
          {"state", Name(job.state)},
          {"progress", std::round(100 * job.progress) / 100},
          {"problem", job.problem}};
}

json HandsToJson(const HeldLoad& held) {
  return {{"is_known", held.load.is_known},
          {"right_kg", held.load.mass_kg[urdf::kRight]},
          {"left_kg", held.load.mass_kg[urdf::kLeft]},
          {"both_kg", held.load.both_kg},
          {"since_micros", held.since_micros == 0 ? json() : json(held.since_micros)},
          {"by", held.by}};
}

// What is known without an option was told to the node of the suit.
const char* OriginOf(bool is_set, bool is_assumed, bool is_option) {
  return is_set ? "operator" : is_assumed ? "assumed" : is_option ? "option" : "bridge";
}

// Neither an operator nor an option of this server has set them.
HeldLoad ToldHands(const PersonState& person, const HeldLoad& first) {
  const HandLoad& stated = person.forces.stated_hand_load;
  if (first.load.is_known || !stated.is_known) return first;
  HeldLoad told = first;
  told.load = stated;
  told.since_micros = 0;
  told.by = "bridge";
  return told;
}

json PersonToJson(const PersonState& person, const ControlStatus& status) {
  const auto found = status.stated.find(person.character);
  const PersonChange stated = found != status.stated.end() ? found->second : PersonChange();
  const auto held = status.held.find(person.character);
  const PersonModel& model = *person.model;
  const urdf::BodyDescription& body = model.description;
  const char* const lengths = model.lengths_are_of_poses   ? "poses"
                              : model.lengths_are_measured ? "stream"
                                                           : "none";
  return {{"character", person.character},
          {"name", {{"value", person.name}, {"from", stated.name ? "operator" : "stream"}}},
          {"mass_kg",
           {{"value", body.mass_kg},
            {"from",
             OriginOf(stated.mass_kg.has_value(), body.mass_is_assumed, status.mass_is_option)}}},
          {"sex",
           {{"value", Name(body.sex)},
            {"from", OriginOf(stated.sex.has_value(), body.sex_is_assumed, status.sex_is_option)}}},
          {"height_m",
           {{"value", std::round(1000 * model.human.skeleton.height) / 1000},
            {"from", model.lengths_are_measured ? lengths
                     : stated.height_m          ? "operator"
                                                : "option"},
            {"stated", stated.height_m ? json(*stated.height_m) : json()}}},
          {"hands", HandsToJson(held != status.held.end() ? held->second
                                                          : ToldHands(person, status.first_held))}};
}

}  // namespace

std::string ToJson(const ControlStatus& status) {
  json people = json::array(), jobs = json::array();
  if (status.state != nullptr) {
    for (const PersonState& person : status.state->people) {
      people.push_back(PersonToJson(person, status));
    }
  }
  for (const Workshop::Job& job : status.jobs) jobs.push_back(JobToJson(job));
  return JsonText(json{{"recording", RecordingToJson(status)},
                       {"clips", {{"why_not", status.why_no_clips}}},
                       {"trials", {{"why_not", status.why_no_trials}}},
                       {"trial", status.trial ? TrialToJson(*status.trial) : json()},
                       {"jobs", std::move(jobs)},
                       {"people", std::move(people)},
                       {"class_limits",
                        {{"value", status.class_limits},
                         {"from", status.class_limits_are_set ? "operator" : "option"}}},
                       {"files_revision", status.files_revision}});
}

std::string FilesToJson(const std::string& folder, std::uint64_t revision, std::int64_t run_micros,
                        const std::vector<recording::FileEntry>& files,
                        const std::vector<recording::Trial>& trials) {
  json entries = json::array(), list = json::array();
  for (const recording::FileEntry& file : files) {
    entries.push_back(
        {{"name", file.name}, {"bytes", file.bytes}, {"modified_micros", file.modified_micros}});
  }
  for (const recording::Trial& trial : trials) list.push_back(TrialToJson(trial));
  json answer = {{"revision", revision},
                 {"run_micros", run_micros},
                 {"files", std::move(entries)},
                 {"trials", std::move(list)}};
  if (!folder.empty()) answer["folder"] = folder;
  return JsonText(answer);
}

std::string TextOf(const HandLoad& load) {
  if (!load.is_known) return "unknown";
  std::string text;
  const auto add = [&text](double kilograms, const char* where) {
    if (kilograms > 0)
      text += fmt::format("{}{:g} kg {}", text.empty() ? "" : ", ", kilograms, where);
  };
  add(load.mass_kg[urdf::kRight], "right");
  add(load.mass_kg[urdf::kLeft], "left");
  add(load.both_kg, "in both");
  return text.empty() ? "empty" : text;
}

}  // namespace kinescope::app
