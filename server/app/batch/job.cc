#include "server/app/batch/job.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <vector>

#include "core/system/errors.h"
#include "core/system/json_parse.h"
#include "core/system/json_text.h"
#include "core/system/sha256.h"
#include "core/system/utf8.h"
#include "core/system/words.h"
#include "server/app/batch/job_command.h"

namespace kinescope::app {
namespace {

using nlohmann::json;

constexpr std::size_t kMostIdBytes = 200, kMostLabels = 32, kMostLabelBytes = 200;
constexpr int kMostJobDepth = 8;

// The members of each object that is open, since the parser keeps the last of two of one name.
class Members {
 public:
  bool operator()(int depth, json::parse_event_t event, json& parsed) {
    if (depth > kMostJobDepth) throw UsageError("more than 8 levels of brackets");
    if (event == json::parse_event_t::object_start) names_.emplace_back();
    if (event == json::parse_event_t::object_end) names_.pop_back();
    if (event == json::parse_event_t::key) {
      const std::string name = parsed.get<std::string>();
      if (!names_.back().insert(name).second) {
        throw UsageError(fmt::format("'{}' is given twice", PrintableLine(name)));
      }
    }
    return true;
  }

 private:
  std::vector<std::set<std::string>> names_;
};

json Parse(std::string_view text) {
  try {
    return ParseJsonOrThrow(text, Members());
  } catch (const json::exception& error) {
    const std::string reason = error.what();  // "[json.exception…] parse error at line 1, …"
    throw UsageError("not valid JSON: " +
                     reason.substr(std::min(reason.find("] ") + 2, reason.size())));
  }
}

std::string TextOf(const json& value, const std::string& name, std::size_t most) {
  if (!value.is_string()) throw UsageError(fmt::format("'{}': expected a text", name));
  std::string text = value.get<std::string>();
  if (text.empty() || text.size() > most || PrintableLine(text) != text) {
    throw UsageError(
        fmt::format("'{}': expected 1 to {} bytes, without control characters", name, most));
  }
  return text;
}

std::map<std::string, std::string> LabelsOf(const json& value) {
  std::map<std::string, std::string> labels;
  if (!value.is_object() || value.size() > kMostLabels) {
    throw UsageError(fmt::format("'labels': expected an object of at most {} texts", kMostLabels));
  }
  for (const auto& [name, text] : value.items()) {
    labels[PrintableLine(name)] = TextOf(text, "labels." + PrintableLine(name), kMostLabelBytes);
  }
  return labels;
}

std::string CommandOf(const json& value) {
  std::string name = TextOf(value, "command", 100);
  const std::vector<std::string> known = CommandsOfJobs();
  for (const std::string& each : known) {
    if (name == each) return name;
  }
  throw UsageError(fmt::format("command={}: expected {}{}", name, Alternatives(known),
                               SuggestionFor(name, known)));
}

void CheckMembers(const json& object) {
  static const std::vector<std::string> kKnown = {"id", "command", "options", "labels"};
  for (const auto& [name, value] : object.items()) {
    if (std::count(kKnown.begin(), kKnown.end(), name) > 0) continue;
    throw UsageError(
        fmt::format("'{}': expected {}{}; options of the command belong into 'options'",
                    PrintableLine(name), Alternatives(kKnown), SuggestionFor(name, kKnown)));
  }
}

}  // namespace

std::string Job::Digest() const {
  Sha256 hash;
  hash.Add(command);
  hash.Add(std::string_view("\0", 1));
  hash.Add(options.dump(-1, ' ', false, json::error_handler_t::replace));
  return hash.Finish();
}

Job ReadJob(std::string_view text) {
  const json object = Parse(text);
  if (!object.is_object()) throw UsageError("expected an object: {\"id\": …, \"command\": …}");
  CheckMembers(object);
  for (const char* name : {"id", "command"}) {
    if (!object.contains(name)) throw UsageError(fmt::format("'{}' is missing", name));
  }
  Job job;
  job.id = TextOf(object.at("id"), "id", kMostIdBytes);
  job.command = CommandOf(object.at("command"));
  if (object.contains("options")) job.options = object.at("options");
  if (!job.options.is_object()) {
    throw UsageError("'options': expected an object of options by their names");
  }
  if (object.contains("labels")) job.labels = LabelsOf(object.at("labels"));
  return job;
}

std::string ToLine(const Job& job) {
  nlohmann::ordered_json line = {{"id", job.id}, {"command", job.command}};
  if (!job.labels.empty()) line["labels"] = job.labels;
  line["options"] = job.options;
  return JsonText(line);
}

}  // namespace kinescope::app
