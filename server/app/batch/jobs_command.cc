// `kinescope jobs`: writes the list of jobs for `kinescope batch`.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/system/errors.h"
#include "core/system/starts_with.h"
#include "core/system/words.h"
#include "server/app/batch/job_command.h"
#include "server/app/batch/job_list.h"
#include "server/app/batch/label_pattern.h"
#include "server/app/commands.h"
#include "server/app/print.h"
#include "server/app/render/draw_pools.h"
#include "server/app/render/output_plan.h"
#include "server/options/option_json.h"
#include "server/options/path_pattern.h"
#include "server/options/text.h"
#include "server/source/scheme.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;
using options::Channel;
using options::Option;

using Names = std::map<std::string, std::string>;  // what stands in braces: its text

struct JobsOptions {
  options::Choice<std::string> command{WordsOfCommands(), "render"};
  options::Text id;
  LabelPattern labels;

  void List(options::OptionList& option) {
    option("command", command, "what the jobs do; its options are given as to itself");
    option("id", id, "name of each job; default: {source}, with several cameras {source}-{camera}");
    option("labels", labels,
           "form of the names of the recordings; each part becomes a label of the job, by which "
           "kinescope study groups, and may stand in other options in braces");
  }

  static options::Choice<std::string>::Words WordsOfCommands() {
    options::Choice<std::string>::Words words;
    for (const std::string& name : CommandsOfJobs()) words.push_back({name, name});
    return words;
  }
};

// What was given for the jobs: patterns of sources, and texts of options by name, in order.
struct Given {
  std::vector<std::string> sources;
  std::vector<std::pair<std::string, std::string>> texts;
};

Given Read(const std::vector<std::string>& words, Command& command) {
  Given given;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (!StartsWith(words[i], "--")) {
      given.sources.push_back(words[i]);
      continue;
    }
    const std::size_t equals = words[i].find('=');
    const std::string name = words[i].substr(2, equals == std::string::npos ? equals : equals - 2);
    const Option* const option = command.options.Find(name);
    if (option == nullptr) {
      throw UsageError(
          fmt::format("unknown option '--{}'{} (see kinescope jobs --help and kinescope "
                      "{} --help)",
                      name, SuggestionFor(name, command.options.Names()), command.name));
    }
    if (equals != std::string::npos) {
      given.texts.emplace_back(name, words[i].substr(equals + 1));
    } else if (option->value->json_kind() == options::JsonKind::kTruth) {
      given.texts.emplace_back(name, "true");
    } else if (i + 1 < words.size()) {
      given.texts.emplace_back(name, words[++i]);
    } else {
      throw UsageError(
          fmt::format("--{}: value missing (see kinescope {} --help)", name, command.name));
    }
  }
  return given;
}

std::vector<std::string> SourcesMatching(const std::vector<std::string>& patterns) {
  std::vector<std::string> sources;
  for (const std::string& pattern : patterns) {
    if (IsSubjectUrl(pattern)) {
      sources.push_back(pattern);
      continue;
    }
    const std::vector<std::string> files = options::FilesMatching(pattern);
    if (files.empty()) throw UsageError(fmt::format("source '{}': no such file", pattern));
    sources.insert(sources.end(), files.begin(), files.end());
  }
  if (sources.empty())
    throw UsageError("source is missing: name recordings, or a pattern in quotes");
  return sources;
}

// A word in braces that is no name stays: patterns of other programs.
std::string Filled(std::string text, const Names& names) {
  for (const auto& [name, value] : names) {
    const std::string place = "{" + name + "}";
    for (std::size_t at = 0; (at = text.find(place, at)) != std::string::npos; at += value.size()) {
      text.replace(at, place.size(), value);
    }
  }
  return text;
}

bool Mentions(const std::string& text, const char* name) {
  return text.find(name) != std::string::npos;
}

class Writer {
 public:
  Writer(const JobsOptions& options, const std::vector<std::string>& words)
      : options_(options), command_(CommandNamed(*options.command, nullptr)) {
    given_ = Read(words, command_);
    sources_ = SourcesMatching(given_.sources);
  }

  JobList Jobs() const {
    JobList list;
    list.path = "job";
    for (const std::string& source : sources_) {
      const Names names = NamesOf(source);
      for (const std::string& camera : Cameras()) {
        Job job = JobOf(source, names, camera);
        job.line = static_cast<int>(list.jobs.size()) + 1;
        list.jobs.push_back(std::move(job));
      }
    }
    return list;
  }

 private:
  // One job for each, if a name of an output tells them apart; else "": one for all.
  std::vector<std::string> Cameras() const {
    std::vector<std::string> cameras;
    bool is_mentioned = Mentions(*options_.id, "{camera}");
    for (const auto& [name, text] : given_.texts) {
      if (name == "camera") cameras = options::SplitItems(text);
      is_mentioned = is_mentioned || Mentions(text, "{camera}");
    }
    if (!is_mentioned || cameras.size() < 2) return {""};
    return cameras;
  }

  Names NamesOf(const std::string& source) const {
    Names names;
    const std::string stem = NameOfSource(source);
    if (options_.labels.IsGiven()) {
      const auto labels = options_.labels.Of(stem);
      if (!labels) {
        throw UsageError(fmt::format("{}: its name '{}' does not have the form --labels={}", source,
                                     stem, options_.labels.ToText()));
      }
      names = *labels;
    }
    names["source"] = stem;
    names["folder"] = fs::path(source).parent_path().filename();
    return names;
  }

  Job JobOf(const std::string& source, Names names, const std::string& camera) const {
    Job job;
    job.command = *options_.command;
    if (options_.labels.IsGiven()) job.labels = *options_.labels.Of(names.at("source"));
    if (!camera.empty()) names["camera"] = NameOfCamera(camera);
    std::string id = *options_.id;
    if (id.empty()) id = camera.empty() ? "{source}" : "{source}-{camera}";
    job.id = Filled(id, names);
    SetOptions(source, names, camera, job);
    return job;
  }

  void SetOptions(const std::string& source, const Names& names, const std::string& camera,
                  Job& job) const {
    std::map<std::string, std::vector<std::string>> texts = {{command_.reads.front(), {source}}};
    for (const auto& [name, text] : given_.texts) {
      const bool is_split = name == "camera" && !camera.empty();
      texts[name].push_back(is_split ? camera : Filled(text, names));
    }
    Command command = CommandNamed(job.command, nullptr);
    for (const auto& [name, values] : texts) {
      Option& option = *command.options.Find(name);
      const bool is_repeatable = option.value->is_repeatable();
      if (!is_repeatable && values.size() > 1) {
        throw UsageError(fmt::format("--{}: given several times; give one value", name));
      }
      const options::Found found = {values.front(), "--",
                                    is_repeatable ? values : std::vector<std::string>()};
      command.options.Set(option, name, found, Channel::kCommandLine);
      job.options[option.name] = options::ToJson(*option.value);
    }
  }

  const JobsOptions& options_;
  Command command_;
  Given given_;
  std::vector<std::string> sources_;
};

void CheckIds(const JobList& list) {
  std::map<std::string, const Job*> seen;
  for (const Job& job : list.jobs) {
    const auto [first, is_new] = seen.emplace(job.id, &job);
    if (is_new) continue;
    throw UsageError(
        fmt::format("two jobs have the id '{}'; tell them apart with --id, such as "
                    "--id '{{folder}}-{{source}}'",
                    job.id));
  }
}

int WriteJobs(const JobsOptions& options, const std::vector<std::string>& words) {
  const JobList list = Writer(options, words).Jobs();
  CheckIds(list);
  const std::vector<std::string> refusals = RefusalsOf(list);
  for (std::size_t i = 0; i < refusals.size(); ++i) {
    if (!refusals[i].empty()) {
      throw UsageError(fmt::format("job '{}': {}", list.jobs[i].id, refusals[i]));
    }
  }
  for (const Job& job : list.jobs) PrintText(stdout, ToLine(job) + "\n");
  return 0;
}

}  // namespace

Command JobsCommand() {
  const auto values = std::make_shared<JobsOptions>();
  Command command = CommandNamed("jobs");
  command.about +=
      "\n  kinescope jobs 'trials/*.mvnx' --camera front,side --out 'clips/{source}-{camera}.mp4'"
      "\n  kinescope jobs 'trials/*.mvnx' --command loads --json 'loads/{source}.json' \\"
      "\n    --labels '{person}_{condition}_{trial}'";
  values->List(command.options);
  command.footer =
      "All other options are those of the command, the same for every job (kinescope render "
      "--help). "
      "In them stand {source}, the name of the recording without folder and ending, {folder}, that "
      "of its folder, {camera}, which makes a job for each camera, and the labels.";
  command.run_with_words = [values](const std::vector<std::string>& words) {
    return WriteJobs(*values, words);
  };
  return command;
}

}  // namespace kinescope::app
