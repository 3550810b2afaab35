#include "server/app/study/trial_loads.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "core/scene_state.h"
#include "core/system/errors.h"
#include "core/system/input_file.h"
#include "core/system/json_parse.h"
#include "core/system/json_text.h"
#include "core/unknown.h"
#include "server/app/loads/load_files.h"
#include "server/table/load_rows.h"

namespace kinescope::app {
namespace {

using nlohmann::json;

// What stands between the samples and the rest. In a text of JSON a quotation mark has a backslash
// before it, so this is no part of one.
constexpr std::string_view kEndOfSamples = "],\"inputs\":";

double NumberOrUnknown(const json& from, const char* name) {
  const json& value = from.at(name);
  return value.is_null() ? kUnknown : value.get<double>();
}

// Not of 1e99: the conversion to a whole number is undefined.
template <class Whole>
Whole WholeIn(const json& from, const char* name) {
  const json& value = from.at(name);
  if (!value.is_number_integer()) {
    throw std::runtime_error(fmt::format("{}: expected a whole number", name));
  }
  return value.get<Whole>();
}

std::string TextIn(const json& from, const char* name) {
  const json& value = from.at(name);
  return value.is_null() ? "" : value.get<std::string>();
}

// What is said of the trial under `name`, if it was not assumed.
std::string StatedIn(const json& person, const char* name) {
  const auto facts = person.find("facts");
  if (facts == person.end()) return "";
  for (const json& fact : *facts) {
    if (TextIn(fact, "name") != name) continue;
    return fact.at("is_assumed").get<bool>() ? "" : TextIn(fact, "value");
  }
  return "";
}

JointLoads JointFrom(const json& from) {
  JointLoads joint;
  for (std::size_t i = 0; i < joint.samples.size(); ++i) {
    const char* const band = Name(static_cast<LoadClass>(i));
    joint.samples[i] = WholeIn<std::uint64_t>(from.at("samples"), band);
  }
  joint.p10 = NumberOrUnknown(from, "p10");
  joint.p50 = NumberOrUnknown(from, "p50");
  joint.p90 = NumberOrUnknown(from, "p90");
  joint.peak = NumberOrUnknown(from, "peak_ratio");
  joint.peak_secs = NumberOrUnknown(from, "peak_time_s");
  joint.peak_moment_Nm = NumberOrUnknown(from, "peak_moment_Nm");
  joint.peak_channel = TextIn(from, "peak_channel");
  const json& high = from.at("above").at(1);
  joint.longest_high_secs = NumberOrUnknown(high, "longest_s");
  joint.rises = WholeIn<std::uint64_t>(high, "rises");
  joint.rises_per_min = NumberOrUnknown(high, "rises_per_min");
  return joint;
}

PersonLoads PersonFrom(const json& from) {
  PersonLoads person;
  person.number = WholeIn<int>(from, "person");
  person.name = TextIn(from, "name");
  person.samples = WholeIn<std::uint64_t>(from, "samples");
  person.secs = NumberOrUnknown(from, "seconds");
  person.mass_kg = NumberOrUnknown(from, "mass_kg");
  person.height_m = NumberOrUnknown(from, "height_m");
  person.sex = StatedIn(from, "sex");
  person.hand_load = StatedIn(from, "hand load");
  person.joints.resize(urdf::kScoredJointCount);
  for (const json& each : from.at("exposure")) {
    const auto name = each.at("joint").get<std::string>();
    for (std::size_t i = 0; i < person.joints.size(); ++i) {
      if (ScoredName(i) == name) person.joints[i] = JointFrom(each);
    }
  }
  const json& compression = from.at("l5_s1_compression_N");
  if (!compression.is_null()) {
    person.compression_most_N = NumberOrUnknown(compression, "most");
    person.compression_mean_N = NumberOrUnknown(compression, "mean");
    // Files of version 0.1.0 and before do not have it.
    const auto above = compression.find("above");
    if (above != compression.end())
      person.compression_above_secs = NumberOrUnknown(above->at(0), "seconds");
  }
  return person;
}

TrialLoads TrialFrom(const json& from) {
  TrialLoads trial;
  trial.source = from.at("source").get<std::string>();
  trial.program = from.at("program").get<std::string>();
  for (const auto& [name, value] : from.at("options").items()) {
    if (!value.is_null()) {
      trial.options[name] = value.is_string() ? value.get<std::string>() : JsonText(value);
    }
  }
  const auto option = [&](const char* name) {
    const auto found = trial.options.find(name);
    return found == trial.options.end() ? std::string() : found->second;
  };
  const std::string sex = option("sex"), hand_load = option("hand_load");
  for (const json& each : from.at("people")) {
    PersonLoads& person = trial.people.emplace_back(PersonFrom(each));
    if (!sex.empty()) person.sex = sex;
    if (!hand_load.empty()) person.hand_load = hand_load;
  }
  return trial;
}

// The end of a file, "" if there is no kEndOfSamples in it.
std::string EndOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const auto bytes = static_cast<std::size_t>(std::max<std::streamoff>(file.tellg(), 0));
  for (std::size_t length = 64 << 10;; length *= 4) {
    length = std::min(length, bytes);
    std::string text(length, '\0');
    file.seekg(static_cast<std::streamoff>(bytes - length));
    if (!file.read(text.data(), static_cast<std::streamsize>(length))) return "";
    const std::size_t at = text.rfind(kEndOfSamples);
    if (at != std::string::npos) return text.substr(at + 2);
    if (length == bytes || length > kMostLoadsBytes) return "";
  }
}

std::string WholeText(InputFile& file) {
  std::string text;
  std::array<char, 1 << 16> piece{};
  while (const std::size_t got = std::fread(piece.data(), 1, piece.size(), file.get())) {
    text.append(piece.data(), got);
    if (text.size() > kMostLoadsBytes) {
      throw std::runtime_error(fmt::format("more than {} MB, and not as kinescope loads writes it",
                                           kMostLoadsBytes >> 20));
    }
  }
  if (!file.failure().empty()) throw std::runtime_error(file.failure());
  return text;
}

}  // namespace

std::uint64_t JointLoads::all_samples() const {
  std::uint64_t all = 0;
  for (const std::uint64_t each : samples) all += each;
  return all;
}

double JointLoads::Percent(LoadClass band) const {
  const std::uint64_t all = all_samples();
  if (all == 0) return kUnknown;
  return 100 * static_cast<double>(samples[static_cast<std::size_t>(band)]) /
         static_cast<double>(all);
}

bool LooksLikeLoads(std::string_view head) {
  const std::size_t schema = head.substr(0, 4096).find("urn:kinescope:loads:");
  return schema != std::string_view::npos && head.find_first_not_of(" \t\r\n") == head.find('{');
}

TrialLoads ParseTrialLoads(std::string_view text) {
  const json whole = ParseJsonOrThrow(text, [](int depth, json::parse_event_t event, json& value) {
    return !(depth == 1 && event == json::parse_event_t::key && value == "samples");
  });
  if (whole.value("schema", "") != kLoadsSchema) {
    throw std::runtime_error(
        fmt::format("expected a JSON file of kinescope loads, \"schema\": \"{}\"", kLoadsSchema));
  }
  return TrialFrom(whole);
}

TrialLoads ReadTrialLoads(const std::string& path) {
  InputFile file = OpenInputFile(path);
  try {
    const bool is_ours = file.head().find(fmt::format("{{\"schema\":\"{}\",", kLoadsSchema)) == 0;
    if (is_ours && !file.is_packed()) {
      const std::string end = EndOf(path);
      if (!end.empty()) return TrialFrom(ParseJsonOrThrow("{" + end));
    }
    return ParseTrialLoads(WholeText(file));
  } catch (const std::exception& error) {
    throw SourceError(fmt::format("{}: {}", path, error.what()));
  }
}

}  // namespace kinescope::app
