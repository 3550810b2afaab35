#include "server/app/study/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <filesystem>
#include <set>
#include <string_view>
#include <system_error>
#include <thread>
#include <unordered_map>
#include <utility>

#include "core/system/errors.h"
#include "core/system/input_file.h"
#include "core/system/starts_with.h"
#include "core/system/stop_signal.h"
#include "server/app/batch/batch_state.h"
#include "server/app/batch/job_list.h"
#include "server/app/batch/results_file.h"
#include "server/options/path_pattern.h"
#include "server/picture/cores.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;
using Labels = std::map<std::string, std::string>;

// Options by which people of one study may differ.
const std::set<std::string> kOfPeople = {
    "sex",  "mass",     "height",  "extra_mass",    "hand_load",
    "tool", "wrenches", "floor_z", "wrench_offset", "capacity_factor"};

// A job, with or without a result, or a file of loads without a job.
struct Entry {
  std::string id, command, state, reason;
  Labels labels;
  std::vector<StudyFile> files;
  std::string loads_path;  // "": it writes none
  std::string source;      // path of the recording, "": unknown
  TrialLoads loads;

  bool is_complete() const { return state == "done" || state == "kept"; }
};

const char* WhatIs(const std::string& option, const std::string& path) {
  if (option == "json") return "loads";
  if (option == "csv") return "CSV";
  if (option == "report") return "report";
  if (option == "plots") return "plots";
  const std::string ending = fs::path(path).extension().string();
  for (const char* picture : {".png", ".jpg", ".jpeg"}) {
    if (ending == picture) return "picture";
  }
  if (ending == ".json") return "record";
  for (const char* figure : {".svg", ".pdf"}) {
    if (ending == figure) return "figure";
  }
  for (const char* clip : {".mp4", ".mkv", ".webm", ".mov", ".gif"}) {
    if (ending == clip) return "clip";
  }
  return "file";
}

// A path in results is relative to the folder in which the batch was started: this one, or that of
// the results.
std::string PlaceOf(const std::string& path, const std::string& results) {
  std::error_code ignored;
  const fs::path beside = fs::path(results).parent_path() / path;
  const fs::path found =
      !fs::exists(path, ignored) && fs::exists(beside, ignored) ? beside : fs::path(path);
  return fs::absolute(found).lexically_normal().string();
}

// "jobs.jsonl" of "jobs.results.jsonl" and of "jobs.results.3-of-16.jsonl".
std::string ListOf(const std::string& results) {
  const std::size_t at = results.rfind(".results.");
  if (at == std::string::npos || !EndsWith(results, ".jsonl")) return "";
  std::string list = results.substr(0, at) + ".jsonl";
  std::error_code ignored;
  return fs::is_regular_file(list, ignored) ? list : "";
}

std::string TextOf(const Labels& labels, const std::string& name) {
  const auto found = labels.find(name);
  return found == labels.end() ? "" : found->second;
}

// "6 kg" before "14 kg".
struct ComesBefore {
  bool operator()(const std::string& a, const std::string& b) const {
    return strverscmp(a.c_str(), b.c_str()) < 0;
  }
};

class Reader {
 public:
  explicit Reader(const StudySettings& settings) : settings_(settings) {}

  Study Read(const std::function<void(std::size_t all)>& step) {
    for (const std::string& path : Paths()) ReadPath(path);
    ReadList();
    study_.jobs = entries_.size();
    ReadLoads(step);
    AddTrials();
    AddFailures();
    AddDifferences();
    return std::move(study_);
  }

 private:
  std::vector<std::string> Paths() const {
    std::vector<std::string> paths;
    for (const std::string& pattern : settings_.paths) {
      const std::vector<std::string> found = options::FilesMatching(pattern);
      if (found.empty()) throw UsageError(fmt::format("results '{}': no such file", pattern));
      paths.insert(paths.end(), found.begin(), found.end());
    }
    return paths;
  }

  void ReadPath(const std::string& path) {
    study_.sources.push_back(path);
    if (LooksLikeLoads(OpenInputFile(path).head())) {
      Entry entry;
      entry.id = fs::path(path).stem().string();
      entry.command = "loads";
      entry.state = "done";
      entry.loads_path = PlaceOf(path, "");
      entry.files = {{"loads", entry.loads_path}};
      Add(std::move(entry), 0);
      return;
    }
    FoundResults found = ReadResults(path);
    for (std::string& fault : found.faults) study_.faults.push_back(std::move(fault));
    if (study_.list.empty()) study_.list = settings_.list.empty() ? ListOf(path) : settings_.list;
    for (const FoundResult& each : found.results) AddResult(each.result, path);
  }

  void AddResult(const JobResult& result, const std::string& path) {
    Entry entry;
    entry.id = result.id;
    entry.command = result.command;
    entry.state = NameOf(result.state);
    entry.reason = result.reason;
    entry.labels = result.labels;
    if (!result.inputs.empty()) entry.source = result.inputs.front().path;
    for (const JobOutput& output : result.outputs) {
      StudyFile file = {WhatIs(output.option, output.stamp.path), PlaceOf(output.stamp.path, path)};
      if (result.command == "loads" && file.what == "loads") entry.loads_path = file.path;
      entry.files.push_back(std::move(file));
    }
    Add(std::move(entry), result.started_millis);
  }

  // The newest of each id counts.
  void Add(Entry entry, std::int64_t started_millis) {
    if (entry.labels.empty() && settings_.labels.IsGiven()) {
      entry.labels = settings_.labels.Of(entry.id).value_or(Labels());
    }
    const auto [found, is_new] = positions_.insert({entry.id, entries_.size()});
    if (is_new) {
      entries_.push_back(std::move(entry));
      started_.push_back(started_millis);
    } else if (started_millis >= started_[found->second]) {
      entries_[found->second] = std::move(entry);
      started_[found->second] = started_millis;
    }
  }

  // Jobs without a result.
  void ReadList() {
    if (!settings_.list.empty()) study_.list = settings_.list;
    if (study_.list.empty()) return;
    JobList list = ReadJobList(study_.list);
    for (std::string& fault : list.faults) study_.faults.push_back(std::move(fault));
    for (const Job& job : list.jobs) {
      if (positions_.count(job.id) > 0) continue;
      Entry entry;
      entry.id = job.id;
      entry.command = job.command;
      entry.state = "missing";
      entry.reason = "no result";
      entry.labels = job.labels;
      Add(std::move(entry), 0);
    }
  }

  void ReadLoads(const std::function<void(std::size_t all)>& step) {
    std::vector<Entry*> todo;
    for (Entry& entry : entries_) {
      if (entry.is_complete() && !entry.loads_path.empty()) todo.push_back(&entry);
    }
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
      for (std::size_t i = next++; i < todo.size() && !StopRequested(); i = next++) {
        try {
          todo[i]->loads = ReadTrialLoads(todo[i]->loads_path);
        } catch (const std::exception& error) {
          todo[i]->state = "failed";
          todo[i]->reason = error.what();
        }
        step(todo.size());
      }
    };
    const auto count = std::min<std::size_t>(todo.size(), static_cast<std::size_t>(CoresHere()));
    std::vector<std::thread> threads;
    for (std::size_t i = 1; i < count; ++i) threads.emplace_back(work);
    work();
    for (std::thread& thread : threads) thread.join();
    if (StopRequested()) throw std::runtime_error("interrupted; nothing was written");
  }

  // Jobs of one trial have the same labels, or the same recording.
  static std::string KeyOf(const Entry& entry) {
    if (entry.labels.empty())
      return entry.source.empty() ? "id " + entry.id : "source " + entry.source;
    std::string key = "labels";
    for (const auto& [name, value] : entry.labels) key += '\n' + name + '=' + value;
    return key;
  }

  void AddTrials() {
    std::map<std::string, std::vector<Entry*>> groups;
    for (Entry& entry : entries_) groups[KeyOf(entry)].push_back(&entry);
    for (const auto& [key, group] : groups) {
      std::vector<Entry*> trials;
      for (Entry* each : group) {
        if (each->command == "loads") trials.push_back(each);
      }
      if (trials.empty()) trials.push_back(group.front());
      for (const Entry* trial : trials) AddTrial(*trial, group);
    }
    std::sort(study_.trials.begin(), study_.trials.end(),
              [](const StudyTrial& a, const StudyTrial& b) {
                if (a.person != b.person) return ComesBefore()(a.person, b.person);
                if (a.condition != b.condition) return ComesBefore()(a.condition, b.condition);
                return ComesBefore()(a.id, b.id);
              });
  }

  void AddTrial(const Entry& entry, const std::vector<Entry*>& group) {
    StudyTrial trial;
    trial.id = entry.id;
    trial.labels = entry.labels;
    trial.condition = TextOf(entry.labels, settings_.condition);
    trial.state = entry.state;
    trial.reason = entry.reason;
    trial.source = entry.loads.source.empty() ? fs::path(entry.source).filename().string()
                                              : entry.loads.source;
    trial.options = entry.loads.options;
    for (const Entry* each : group) {
      if (each != &entry && each->command == "loads") continue;
      for (const StudyFile& file : each->files) trial.files.push_back(file);
    }
    if (!entry.loads.program.empty()) ++study_.programs[entry.loads.program];
    const std::vector<PersonLoads>& people = entry.loads.people;
    if (people.empty()) {
      trial.person = TextOf(entry.labels, settings_.person);
      if (entry.is_complete()) trial.reason = "no loads were asked for";
      study_.trials.push_back(std::move(trial));
      return;
    }
    for (const PersonLoads& person : people) {
      trial.loads = person;
      trial.person = PersonOf(entry, person, people.size());
      study_.trials.push_back(trial);
    }
  }

  std::string PersonOf(const Entry& entry, const PersonLoads& person, std::size_t people) const {
    std::string label = TextOf(entry.labels, settings_.person);
    if (people == 1 && !label.empty()) return label;
    const std::string name =
        person.name.empty() ? fmt::format("person {}", person.number) : person.name;
    if (label.empty()) return person.name.empty() && people == 1 ? "" : name;
    return label + ", " + name;
  }

  void AddFailures() {
    for (const Entry& entry : entries_) {
      if (entry.is_complete()) continue;
      study_.failures.push_back(
          {entry.id, entry.command, entry.state, entry.reason, KindOfReason(entry.reason)});
    }
  }

  void AddDifferences() {
    std::map<std::string, std::map<std::string, std::size_t>> values;
    std::size_t trials = 0;
    for (const StudyTrial& trial : study_.trials) {
      if (!trial.loads) continue;
      ++trials;
      for (const auto& [option, value] : trial.options) {
        if (kOfPeople.count(option) == 0) ++values[option][value];
      }
    }
    for (auto& [option, counts] : values) {
      std::size_t given = 0;
      for (const auto& [value, count] : counts) given += count;
      if (given < trials) counts["not given"] += trials - given;
      if (counts.size() > 1) study_.differences.push_back({option, std::move(counts)});
    }
  }

  const StudySettings& settings_;
  Study study_;
  std::vector<Entry> entries_;
  std::vector<std::int64_t> started_;                       // of each, ms since 1970
  std::unordered_map<std::string, std::size_t> positions_;  // in entries_, by id
};

std::vector<std::string> Each(const std::vector<StudyTrial>& trials,
                              std::string StudyTrial::*what) {
  std::set<std::string, ComesBefore> values;
  for (const StudyTrial& trial : trials) values.insert(trial.*what);
  return {values.begin(), values.end()};
}

bool DiffersFromJobToJob(std::string_view word) {
  return word.find_first_of("0123456789/") != std::string_view::npos ||
         (word.find('.') != std::string_view::npos && word.find('.') + 1 < word.size());
}

}  // namespace

std::size_t Study::with_loads() const {
  return static_cast<std::size_t>(
      std::count_if(trials.begin(), trials.end(),
                    [](const StudyTrial& trial) { return trial.loads.has_value(); }));
}

std::vector<std::string> Study::People() const { return Each(trials, &StudyTrial::person); }

std::vector<std::string> Study::Conditions() const { return Each(trials, &StudyTrial::condition); }

Study ReadStudy(const StudySettings& settings, const std::function<void(std::size_t all)>& step) {
  return Reader(settings).Read(step);
}

std::string KindOfReason(const std::string& reason) {
  std::string kind;
  bool was_left_out = false;
  for (std::size_t at = 0; at < reason.size();) {
    const std::size_t end = std::min(reason.find(' ', at), reason.size());
    const std::string word = reason.substr(at, end - at);
    const bool is_left_out = DiffersFromJobToJob(word);
    if (!is_left_out || !was_left_out) {
      if (!kind.empty()) kind += ' ';
      kind += is_left_out ? "…" : word;
    }
    was_left_out = is_left_out;
    at = end + 1;
  }
  constexpr std::string_view kStart = "… ";
  return kind.compare(0, kStart.size(), kStart) == 0 ? kind.substr(kStart.size()) : kind;
}

}  // namespace kinescope::app
