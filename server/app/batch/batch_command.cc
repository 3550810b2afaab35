// `kinescope batch`: the jobs of a list, or a share of them.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/system/errors.h"
#include "core/system/stop_signal.h"
#include "core/system/words.h"
#include "server/app/batch/batch_run.h"
#include "server/app/batch/batch_state.h"
#include "server/app/batch/job_list.h"
#include "server/app/batch/job_worker.h"
#include "server/app/batch/results_file.h"
#include "server/app/commands.h"
#include "server/app/print.h"
#include "server/app/progress.h"
#include "server/app/shard.h"
#include "server/options/path_pattern.h"
#include "server/picture/cores.h"

namespace kinescope::app {
namespace {

struct BatchOptions {
  options::Text list;
  ShardValue shard;
  options::Whole jobs{1, {0, 1024, ""}};
  options::Texts results;
  options::Number job_limit_secs{0, {0, 604'800, "s", false, "0: none"}};
  options::Flag check, answers;
  options::Choice<bool> retry{{{"open", false}, {"failed", true}}, false};

  void List(options::OptionList& option) {
    option("list", list, "list of jobs, JSON Lines (docs/many_machines.md)");
    option("shard", shard, "the share of the jobs to do, by a hash of their ids");
    option("jobs", jobs,
           "jobs at a time; each in a process of its own, on one core; 0: as many as there are "
           "cores");
    option(
        "results", results,
        "file of results, a line for each job that has ended; what is complete in it is not done "
        "again; -: standard output; with --check several, or a pattern in quotes; default: "
        "LIST.results.jsonl, of a share LIST.results.K-of-N.jsonl");
    option("retry", retry,
           "which jobs to do: open: those without a result and those that were "
           "interrupted; failed: also those that failed");
    option("check", check, "says which jobs are not complete, and does none");
    option("job_limit_secs", job_limit_secs,
           "time after which a job is given up as one that hangs");
    option.Group(options::kHidden);
    option("answers", answers, "does the jobs that come over a channel");
    option.HasNoEffect("job_limit_secs", "with --check", [this] { return *check; });
    option.HasNoEffect("jobs", "with --check", [this] { return *check; });
    option.HasNoEffect("retry", "with --check", [this] { return *check; });
  }
};

// How many jobs ended how.
struct Counts {
  std::size_t complete = 0, failed = 0, interrupted = 0, before = 0;

  void Add(JobState state) {
    if (state == JobState::kFailed) {
      ++failed;
    } else if (state == JobState::kInterrupted) {
      ++interrupted;
    } else {
      ++complete;
    }
  }
};

std::string ShareText(const Shard& shard) {
  return shard.count == 1 ? "" : fmt::format(" in shard {}/{}", shard.number, shard.count);
}

void SayFaults(const std::vector<std::string>& faults) {
  for (const std::string& fault : faults) spdlog::error("{}", fault);
}

// Where results go.
class ResultsOut {
 public:
  explicit ResultsOut(const std::string& path) {
    if (path != "-") file_.emplace(path);
  }

  bool is_stdout() const { return !file_; }
  void KeepOnly(const std::vector<std::string>& lines) { file_->KeepOnly(lines); }
  void Add(const JobResult& result) {
    if (file_) return file_->Add(result);
    PrintText(stdout, ToLine(result) + "\n");
    std::fflush(stdout);
  }
  void Finish() {
    if (file_) file_->Finish();
  }

 private:
  std::optional<ResultsFile> file_;
};

class Batch {
 public:
  explicit Batch(const BatchOptions& options)
      : options_(options),
        list_(ReadJobList(*options.list)),
        path_(PathOfResults(options)),
        output_(path_) {
    if (!output_.is_stdout()) found_.push_back(ReadResults(path_));
    if (HasUnfinishedLine()) {
      spdlog::warn("{}: its last line is not finished and was dropped; the job is done again",
                   path_);
    }
    faults_ = list_.faults;
    for (std::string& fault : FaultsOf(found_, list_)) faults_.push_back(std::move(fault));
    SayFaults(faults_);
  }

  int Run() {
    Choose();
    MakeRoom();
    Do();
    PrintSummary();
    output_.Finish();
    if (StopSignal() != 0) return 128 + StopSignal();
    return counts_.failed + counts_.interrupted > 0 || !faults_.empty() ? 1 : 0;
  }

 private:
  static std::string PathOfResults(const BatchOptions& options) {
    if (options.results->size() > 1) {
      throw UsageError("--results: one file is written; several are read with --check");
    }
    return options.results->empty() ? DefaultResultsOf(*options.list, *options.shard)
                                    : options.results->front();
  }

  bool HasUnfinishedLine() const { return !found_.empty() && found_.front().has_unfinished_line; }

  void Choose() {
    const std::vector<std::string> refusals = RefusalsOf(list_);
    standings_ = StandingsOf(list_, *options_.shard, found_);
    for (const JobStanding& each : standings_) {
      const auto position = static_cast<std::size_t>(each.job - list_.jobs.data());
      if (!refusals[position].empty()) {
        refused_.push_back({each.job, refusals[position]});
      } else if (each.standing == Standing::kComplete) {
        ++counts_.before;
        ++counts_.complete;
        continue;
      } else if (each.standing == Standing::kFailed && !*options_.retry) {
        ++counts_.failed;
        continue;
      } else {
        todo_.push_back(each.job);
      }
      attempts_[each.job->id] = each.found == nullptr ? 0 : each.found->result.attempts;
      again_.insert(each.job->id);
    }
  }

  // Each job has one line: those of the jobs that are done again go.
  void MakeRoom() {
    if (output_.is_stdout()) return;
    const FoundResults& found = found_.front();
    std::set<const FoundResult*> newest;
    for (const JobStanding& each : standings_) newest.insert(each.found);
    const std::set<std::string> shares = IdsOfShare();
    std::vector<std::string> kept = found.faulty_lines;
    for (const FoundResult& each : found.results) {
      const std::string& id = each.result.id;
      const bool is_ours = shares.count(id) > 0;
      if (!is_ours || (newest.count(&each) > 0 && again_.count(id) == 0)) kept.push_back(each.text);
    }
    const std::size_t lines = found.results.size() + found.faulty_lines.size();
    if (kept.size() < lines || found.has_unfinished_line) output_.KeepOnly(kept);
  }

  std::set<std::string> IdsOfShare() const {
    std::set<std::string> ids;
    for (const JobStanding& each : standings_) ids.insert(each.job->id);
    return ids;
  }

  void Do() {
    progress_.emplace("jobs:", static_cast<int>(todo_.size() + refused_.size()));
    for (const auto& [job, reason] : refused_) {
      JobResult result = ResultFor(*job);
      result.state = JobState::kFailed;
      result.reason = reason;
      Take(std::move(result));
    }
    BatchSettings settings;
    settings.jobs = *options_.jobs > 0 ? static_cast<int>(*options_.jobs) : CoresHere();
    settings.limit_secs = *options_.job_limit_secs;
    DoJobs(todo_, settings, [this](JobResult result) { Take(std::move(result)); });
    progress_.reset();
  }

  void Take(JobResult result) {
    result.attempts += attempts_[result.id];
    counts_.Add(result.state);
    output_.Add(result);
    for (const std::string& warning : result.warnings) {
      spdlog::warn("{}: {}", result.id, warning);
    }
    if (!output_.is_stdout()) PrintResult(result);
    progress_->Step();
  }

  void PrintResult(const JobResult& result) const {
    Print("{:<12}{:9.2f} s  {}", NameOf(result.state), result.secs, result.id);
    if (!result.is_complete()) Print(" ({}): {}", PlaceOf(result.id), result.reason);
    PrintText(stdout, "\n");
    std::fflush(stdout);  // a log shows it now
  }

  std::string PlaceOf(const std::string& id) const {
    const auto job = std::find_if(list_.jobs.begin(), list_.jobs.end(),
                                  [&](const Job& each) { return each.id == id; });
    return list_.PlaceOf(*job);
  }

  void PrintSummary() const {
    if (output_.is_stdout()) return;
    const std::string share = ShareText(*options_.shard);
    if (standings_.empty()) {
      Print("none of the {}{}: nothing to do\n", Counted(list_.jobs.size(), "job"),
            share.empty() ? "" : " is" + share);
      return;
    }
    Print("{}{}: {} complete{}, {} failed{}; results: {}\n", Counted(standings_.size(), "job"),
          share, counts_.complete,
          counts_.before > 0 ? fmt::format(" ({} of them before)", counts_.before) : "",
          counts_.failed,
          counts_.interrupted > 0 ? fmt::format(", {} interrupted", counts_.interrupted) : "",
          path_);
    if (counts_.interrupted > 0) Print("To do the interrupted ones: the same again\n");
    if (counts_.failed > 0) Print("To do the failed ones again: the same with --retry failed\n");
  }

  struct Refused {
    const Job* job;
    std::string reason;
  };

  const BatchOptions& options_;
  const JobList list_;
  const std::string path_;
  ResultsOut output_;  // locks the results, so it is opened before they are read
  std::vector<FoundResults> found_;
  std::vector<std::string> faults_;
  std::vector<JobStanding> standings_;
  std::vector<const Job*> todo_;
  std::vector<Refused> refused_;
  std::set<std::string> again_;          // ids of the jobs that get a new result
  std::map<std::string, int> attempts_;  // before, by id
  std::optional<Progress> progress_;
  Counts counts_;
};

std::vector<FoundResults> ReadAllResults(const BatchOptions& options) {
  std::vector<std::string> paths;
  for (const std::string& pattern : *options.results) {
    const std::vector<std::string> files = options::FilesMatching(pattern);
    if (files.empty()) throw UsageError("--results=" + pattern + ": no such file");
    paths.insert(paths.end(), files.begin(), files.end());
  }
  if (options.results->empty()) paths = FindResultsOf(*options.list);
  std::vector<FoundResults> all;
  all.reserve(paths.size());
  for (const std::string& path : paths) all.push_back(ReadResults(path));
  return all;
}

const char* WordOf(Standing standing) {
  switch (standing) {
    case Standing::kComplete: return "complete";
    case Standing::kMissing: return "missing";
    case Standing::kInterrupted: return "interrupted";
    case Standing::kFailed: return "failed";
    case Standing::kStale: return "outdated";
  }
  return "";
}

int Check(const BatchOptions& options) {
  const JobList list = ReadJobList(*options.list);
  const std::vector<FoundResults> results = ReadAllResults(options);
  std::vector<std::string> faults = list.faults;
  for (std::string& fault : FaultsOf(results, list)) faults.push_back(std::move(fault));
  SayFaults(faults);
  const std::vector<JobStanding> standings = StandingsOf(list, *options.shard, results);
  std::size_t open = 0;
  for (const JobStanding& each : standings) {
    if (each.standing == Standing::kComplete) continue;
    ++open;
    Print("{:<12}{} ({}){}\n", WordOf(each.standing), each.job->id, list.PlaceOf(*each.job),
          each.why.empty() ? "" : ": " + each.why);
  }
  Print(
      "{} of {}{} complete, by {}\n", standings.size() - open, Counted(standings.size(), "job"),
      ShareText(*options.shard),
      results.size() == 1 ? results.front().path : Counted(results.size(), "file") + " of results");
  return open > 0 || !faults.empty() ? 1 : 0;
}

}  // namespace

Command BatchCommand() {
  const auto values = std::make_shared<BatchOptions>();
  Command command = CommandNamed("batch");
  command.shows_progress = true;
  command.about +=
      "\n  kinescope jobs 'trials/*.mvnx' --out 'clips/{source}.mp4' > jobs.jsonl"
      "\n  kinescope batch jobs.jsonl --jobs 4"
      "\n  kinescope batch jobs.jsonl --shard 3/16      (on each of 16 machines its own)"
      "\n  kinescope batch jobs.jsonl --check           (is all of it there?)";
  values->List(command.options);
  command.positionals = {"list"};
  command.footer =
      "Exit code: 0 all jobs of the share are complete, 1 one failed, or a line is wrong, 2 "
      "nothing "
      "could be begun; 143 ended by SIGTERM, 130 by Ctrl-C: the same command goes on.";
  command.run = [values](options::OptionList&) {
    if (*values->answers) return WorkOff();
    if (values->list->empty()) throw UsageError("--list is missing: name the list of jobs");
    return *values->check ? Check(*values) : Batch(*values).Run();
  };
  return command;
}

}  // namespace kinescope::app
