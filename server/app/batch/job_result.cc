#include "server/app/batch/job_result.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "core/system/clocks.h"
#include "core/system/json_parse.h"
#include "core/system/json_text.h"
#include "server/app/ordered_json.h"

namespace kinescope::app {
namespace {

using nlohmann::json;
using DeclaredKind = DeclaredOutput::Kind;

constexpr std::array<std::pair<JobState, const char*>, 4> kStates = {{
    {JobState::kDone, "done"},
    {JobState::kKept, "kept"},
    {JobState::kFailed, "failed"},
    {JobState::kInterrupted, "interrupted"},
}};

constexpr std::array<std::pair<DeclaredKind, const char*>, 3> kKinds = {
    {{DeclaredKind::kFile, "file"},
     {DeclaredKind::kNumbered, "numbered"},
     {DeclaredKind::kFolder, "folder"}}};

template <class Value, std::size_t n>
const char* NameIn(const std::array<std::pair<Value, const char*>, n>& names, Value value) {
  for (const auto& [each, name] : names) {
    if (each == value) return name;
  }
  return "";
}

template <class Value, std::size_t n>
Value ValueIn(const std::array<std::pair<Value, const char*>, n>& names, const std::string& name) {
  for (const auto& [each, known] : names) {
    if (name == known) return each;
  }
  throw std::runtime_error("'" + name + "' is not known");
}

Json ToJson(const FileStamp& stamp) {
  return {{"path", stamp.path},
          {"files", stamp.files},
          {"bytes", stamp.bytes},
          {"modified_ns", stamp.modified_nanos}};
}

FileStamp StampFrom(const json& from) {
  return {from.at("path").get<std::string>(), from.at("files").get<std::int64_t>(),
          from.at("bytes").get<std::int64_t>(), from.at("modified_ns").get<std::int64_t>()};
}

Json ToJson(const JobOutput& output) {
  Json members = {{"option", output.option}, {"kind", NameIn(kKinds, output.kind)}};
  members.update(ToJson(output.stamp));
  members["sha256"] = output.sha256;
  return members;
}

JobOutput OutputFrom(const json& from) {
  return {from.at("option").get<std::string>(), StampFrom(from),
          from.at("sha256").get<std::string>(),
          ValueIn(kKinds, from.at("kind").get<std::string>())};
}

std::string UtcText(std::int64_t millis) {
  const std::time_t secs = millis / 1000;
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03d}Z", fmt::gmtime(secs), millis % 1000);
}

std::int64_t MillisFrom(const std::string& text) {
  std::tm parts = {};
  const char* const rest = ::strptime(text.c_str(), "%Y-%m-%dT%H:%M:%S.", &parts);
  if (rest == nullptr) throw std::runtime_error("started: expected a time");
  return ::timegm(&parts) * std::int64_t{1000} + std::strtol(rest, nullptr, 10);
}

double TenThousandths(double value) { return std::round(value * 1e4) / 1e4; }

std::string HostName() {
  std::array<char, 256> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0) return "";
  return name.data();
}

std::string WhyOutputStale(const JobOutput& output) {
  const DeclaredOutput declared = {output.option, output.stamp.path, output.kind};
  const FileStamp now = StampOf(declared);
  if (now == output.stamp) return "";
  if (now.files == 0) return output.stamp.path + " is missing";
  const bool is_equal = now.files == output.stamp.files && now.bytes == output.stamp.bytes &&
                        HashOf(declared) == output.sha256;
  return is_equal ? "" : output.stamp.path + " has changed since";
}

}  // namespace

const char* NameOf(JobState state) { return NameIn(kStates, state); }

JobResult ResultFor(const Job& job) {
  JobResult result;
  result.id = job.id;
  result.command = job.command;
  result.labels = job.labels;
  result.digest = job.Digest();
  result.host = HostName();
  result.started_millis = WallNanos() / kNanosPerMilli;
  return result;
}

std::string ToLine(const JobResult& result) {
  Json line = {{"id", result.id}, {"state", NameOf(result.state)}};
  if (!result.reason.empty()) line["reason"] = result.reason;
  line["command"] = result.command;
  if (!result.labels.empty()) line["labels"] = result.labels;
  line["seconds"] = TenThousandths(result.secs);
  line["cpu_seconds"] = TenThousandths(result.cpu_secs);
  line["peak_memory_bytes"] = result.peak_memory_bytes;
  line["started"] = UtcText(result.started_millis);
  line["host"] = result.host;
  line["attempts"] = result.attempts;
  line["job_sha256"] = result.digest;
  line["outputs"] = Json::array();
  for (const JobOutput& output : result.outputs) line["outputs"].push_back(ToJson(output));
  line["inputs"] = Json::array();
  for (const FileStamp& input : result.inputs) line["inputs"].push_back(ToJson(input));
  if (!result.warnings.empty()) line["warnings"] = result.warnings;
  return JsonText(line);
}

JobResult ReadResult(std::string_view line) {
  const json from = ParseJsonOrThrow(line);
  JobResult result;
  result.id = from.at("id").get<std::string>();
  result.state = ValueIn(kStates, from.at("state").get<std::string>());
  result.reason = from.value("reason", "");
  result.command = from.at("command").get<std::string>();
  if (from.contains("labels")) from.at("labels").get_to(result.labels);
  result.secs = from.at("seconds").get<double>();
  result.cpu_secs = from.at("cpu_seconds").get<double>();
  result.peak_memory_bytes = from.at("peak_memory_bytes").get<std::int64_t>();
  result.started_millis = MillisFrom(from.at("started").get<std::string>());
  result.host = from.at("host").get<std::string>();
  result.attempts = from.at("attempts").get<int>();
  result.digest = from.at("job_sha256").get<std::string>();
  for (const json& each : from.at("outputs")) result.outputs.push_back(OutputFrom(each));
  for (const json& each : from.at("inputs")) result.inputs.push_back(StampFrom(each));
  if (from.contains("warnings")) from.at("warnings").get_to(result.warnings);
  return result;
}

std::string WhyStale(const JobResult& result, const Job& job) {
  if (result.digest != job.Digest()) return "the job has changed since";
  for (const FileStamp& input : result.inputs) {
    const FileStamp now = StampOf(input.path);
    // One that is gone, to an archive perhaps, makes no other result.
    if (now.files > 0 && !(now == input)) return input.path + " has changed since";
  }
  for (const JobOutput& output : result.outputs) {
    std::string why = WhyOutputStale(output);
    if (!why.empty()) return why;
  }
  return "";
}

}  // namespace kinescope::app
